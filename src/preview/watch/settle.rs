//! When what is found in the file counts: the decisions of watching, without files or clocks.
//!
//! A save is not one moment: the file may be empty or missing for a while, or half written. What is found is told once
//! it is found again a little later; an empty or missing file only when it stays so, since far more often it is on its
//! way.

use std::time::Duration;

use sha2::{Digest, Sha256};

use super::News;

/// How long a text has to stay as it is.
const QUIET: Duration = Duration::from_millis(6);

/// How long a file has to stay empty, missing or unreadable.
const ABSENT: Duration = Duration::from_millis(300);

/// How long a text may keep changing before it is told nonetheless.
const LONGEST: Duration = Duration::from_millis(200);

/// What was told and what is not settled yet; nothing of the text itself. Times are since any one moment.
#[derive(Debug, Default)]
pub(super) struct Settle {
    told: Option<Mark>,
    unsettled: Option<Unsettled>,
}

/// News that are perhaps on their way to something else.
#[derive(Debug)]
struct Unsettled {
    mark: Mark,
    /// Since when it is found.
    since: Duration,
    /// Since when some text or other is found that was not told.
    text_since: Option<Duration>,
    /// When it counts if it is still found.
    due: Duration,
}

/// News are the same when this is.
#[derive(Debug, PartialEq, Eq)]
enum Mark {
    Text([u8; 32]),
    Gone,
    Unreadable(String),
}

impl Mark {
    fn of(news: &News) -> Mark {
        match news {
            News::Text(bytes) => Mark::Text(Sha256::digest(bytes).into()),
            News::Gone => Mark::Gone,
            News::Unreadable(why) => Mark::Unreadable(why.clone()),
        }
    }
}

impl Settle {
    /// `found` is what the file is at `now`. Returns it when it is to be told; the first time it always is.
    pub(super) fn look(&mut self, now: Duration, found: News) -> Option<News> {
        let mark = Mark::of(&found);
        if self.told.as_ref() == Some(&mark) {
            self.unsettled = None;
            return None;
        }
        let before = self.unsettled.take();
        let since = match &before {
            Some(before) if before.mark == mark => before.since,
            _ => now,
        };
        let has_text = matches!(&found, News::Text(bytes) if !bytes.is_empty());
        let text_since = before
            .and_then(|before| before.text_since)
            .or(has_text.then_some(now));
        let due = if !has_text {
            since + ABSENT
        } else {
            text_since.map_or(since + QUIET, |text| (since + QUIET).min(text + LONGEST))
        };
        if self.told.is_none() || now >= due {
            self.told = Some(mark);
            return Some(found);
        }
        self.unsettled = Some(Unsettled {
            mark,
            since,
            text_since,
            due,
        });
        None
    }

    /// When to look again at the latest, sign or no sign; none while all is told.
    pub(super) fn next(&self) -> Option<Duration> {
        self.unsettled.as_ref().map(|unsettled| unsettled.due)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> News {
        News::Text(text.into())
    }

    fn at(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    /// One that has told `old` at time 0.
    fn told_old() -> Settle {
        let mut settle = Settle::default();
        assert_eq!(settle.look(at(0), text("old")), Some(text("old")));
        assert_eq!(settle.next(), None);
        settle
    }

    /// Looks as the thread does without signs: at `from`, then whenever the machine says so, until `until`; the file is
    /// what `file` says at that time (ms). Returns what was told, and when.
    fn follow(
        settle: &mut Settle,
        from: u64,
        until: u64,
        file: impl Fn(u64) -> News,
    ) -> Vec<(u64, News)> {
        let mut told = Vec::new();
        let mut now = at(from);
        while now < at(until) {
            let ms = now.as_millis() as u64;
            told.extend(settle.look(now, file(ms)).map(|news| (ms, news)));
            let next = settle.next().unwrap_or(now + at(1));
            assert!(next > now, "looks go on in time");
            now = next;
        }
        told
    }

    #[test]
    fn what_there_is_at_first_is_told_at_once() {
        for first in [
            text("a"),
            text(""),
            News::Gone,
            News::Unreadable("why".into()),
        ] {
            let mut settle = Settle::default();
            assert_eq!(settle.look(at(7), first.clone()), Some(first.clone()));
            assert_eq!(settle.look(at(8), first), None);
            assert_eq!(settle.next(), None);
        }
    }

    #[test]
    fn a_save_is_told_after_the_quiet_time_and_once() {
        let mut settle = told_old();
        assert_eq!(settle.look(at(100), text("new")), None);
        assert_eq!(settle.next(), Some(at(106)));
        assert_eq!(settle.look(at(105), text("new")), None);
        assert_eq!(
            settle.next(),
            Some(at(106)),
            "a look in between changes nothing"
        );
        assert_eq!(settle.look(at(106), text("new")), Some(text("new")));
        assert_eq!(settle.look(at(107), text("new")), None);
        assert_eq!(settle.next(), None);
    }

    #[test]
    fn the_same_text_again_is_no_news() {
        let mut settle = told_old();
        // Truncated and written as it was; deleted and made as it was.
        for between in [text(""), News::Gone] {
            assert_eq!(settle.look(at(100), between), None);
            assert_eq!(settle.look(at(101), text("old")), None);
            assert_eq!(settle.next(), None);
            assert_eq!(settle.look(at(2000), text("old")), None);
        }
    }

    #[test]
    fn a_file_that_is_empty_or_missing_for_a_moment_is_not_told_so() {
        for between in [
            text(""),
            News::Gone,
            News::Unreadable("permission denied".into()),
        ] {
            let mut settle = told_old();
            let told = follow(&mut settle, 100, 1000, |ms| match ms {
                ..399 => between.clone(),
                _ => text("new"),
            });
            // Without a sign it is looked at when it would count; it is the new text by then.
            assert_eq!(told, [(406, text("new"))]);
        }
    }

    #[test]
    fn a_file_that_stays_empty_or_missing_is_told_so() {
        for gone in [text(""), News::Gone, News::Unreadable("why".into())] {
            let mut settle = told_old();
            let told = follow(&mut settle, 100, 2000, |_| gone.clone());
            assert_eq!(told, [(400, gone)]);
            // And the same text is news after that.
            let told = follow(&mut settle, 2000, 3000, |_| text("old"));
            assert_eq!(told, [(2006, text("old"))]);
        }
    }

    #[test]
    fn emptiness_and_absence_count_each_for_itself() {
        let mut settle = told_old();
        assert_eq!(settle.look(at(100), News::Gone), None);
        assert_eq!(settle.look(at(399), text("")), None);
        assert_eq!(settle.next(), Some(at(699)));
        assert_eq!(settle.look(at(698), text("")), None);
        assert_eq!(settle.look(at(699), text("")), Some(text("")));
    }

    #[test]
    fn a_text_that_keeps_changing_is_told_after_the_longest_time() {
        let mut settle = told_old();
        let told = follow(&mut settle, 1000, 1650, |ms| text(&ms.to_string()));
        let when: Vec<u64> = told.iter().map(|told| told.0).collect();
        // The next 200 ms begin with the next look that finds something new.
        assert_eq!(when, [1200, 1401, 1602]);
        for (ms, news) in told {
            assert_eq!(news, text(&ms.to_string()), "what it was then");
        }
    }

    #[test]
    fn moments_without_text_do_not_put_it_off_for_ever() {
        let mut settle = told_old();
        let mut told = None;
        for ms in 100..500 {
            let found = if ms % 2 == 0 {
                text(&ms.to_string())
            } else {
                text("")
            };
            let news = settle.look(at(ms), found);
            assert!(news != Some(text("")), "empty for a moment only");
            if told.is_none() && news.is_some() {
                told = Some(ms);
            }
        }
        assert_eq!(told, Some(300));
    }

    #[test]
    fn a_text_after_a_long_emptiness_still_has_its_quiet_time() {
        let mut settle = told_old();
        assert_eq!(settle.look(at(100), text("")), None);
        assert_eq!(settle.look(at(390), text("half")), None);
        assert_eq!(settle.look(at(393), text("half and half")), None);
        assert_eq!(settle.next(), Some(at(399)));
        assert_eq!(
            settle.look(at(399), text("half and half")),
            Some(text("half and half"))
        );
    }

    #[test]
    fn two_saves_are_two_news_or_one_but_end_with_the_last() {
        // The second one within the quiet time of the first.
        let mut settle = told_old();
        let told = follow(&mut settle, 100, 300, |ms| {
            text(if ms < 104 { "one" } else { "two" })
        });
        assert_eq!(told, [(112, text("two"))]);
        // And after it.
        let mut settle = told_old();
        let told = follow(&mut settle, 100, 300, |ms| {
            text(if ms < 150 { "one" } else { "two" })
        });
        assert_eq!(told, [(106, text("one")), (156, text("two"))]);
    }

    #[test]
    fn another_reason_is_other_news() {
        let mut settle = told_old();
        let reason = |why: &str| News::Unreadable(why.into());
        let told = follow(&mut settle, 100, 1500, |ms| {
            reason(if ms < 600 { "one" } else { "two" })
        });
        assert_eq!(told, [(400, reason("one")), (900, reason("two"))]);
    }
}
