//! The numbers of an attribute: how many there are, what each is, and whether they keep their row's limit. Part of
//! `values` in the flow text → lex → parse → [`Scene`](super::Scene).

use std::ops::Range;

use super::common_mistakes;
use super::lex::{Token, TokenKind};
use super::limit::Limit;
use super::number::{self, NumberError, looks_numeric};
use super::parser::{Block, Parser};
use super::table::{Attribute, Field};
use super::values::give_rows_in;
use crate::diagnostic::Diagnostic;

/// The most numbers that an attribute takes: a quadric's coefficients.
pub(crate) const MOST_NUMBERS: usize = 10;

/// Numbers as they are read.
struct Numbers<'t> {
    values: [f64; MOST_NUMBERS],
    tokens: Vec<Token<'t>>,
    /// Numbers beyond those that the row takes: where the first of them starts, and how many there are.
    extra: Option<(usize, usize)>,
    /// Whether all of them could be read.
    good: bool,
}

impl Numbers<'_> {
    /// How many numbers stand there.
    fn found(&self) -> usize {
        self.tokens.len() + self.extra.map_or(0, |(_, count)| count)
    }
}

impl<'t> Parser<'t> {
    /// Reads numbers, checks how many and whether they keep the row's limit, and puts them where they go.
    pub(super) fn numbers(
        &mut self,
        block: &mut Block,
        row: &'static Attribute,
        key: Token<'t>,
        counts: Range<usize>,
        whole: bool,
        field: Field,
    ) -> bool {
        let max = counts.end - 1;
        if let Some(punctuated) = self.punctuated_numbers(max) {
            let message = format!(
                "`{}` takes {}, found {}",
                row.name,
                takes(&counts),
                punctuated.quoted
            );
            let error = Diagnostic::new(punctuated.span, message);
            self.errors.report(error.help(punctuated.help));
            return false;
        }
        let Some(mut numbers) = self.read_numbers(block, &counts, whole) else {
            return false;
        };
        let found = numbers.found();
        // An attribute that takes one or three numbers does not take two.
        if found != max && found != counts.start {
            let error = wrong_count(row, &numbers, &counts, key.start..self.last_end);
            self.errors.report(error);
            return false;
        }
        if !numbers.good {
            return false;
        }
        if found < max {
            let value = numbers.values[0];
            numbers.values[..max].fill(value);
        }
        let kept = self.check_limit(row, &numbers, max);
        field(&mut block.draft).copy_from_slice(&numbers.values[..max]);
        kept
    }

    /// Reads all numbers that stand here. None where one token held more than one: how many were meant is not known.
    fn read_numbers(
        &mut self,
        block: &mut Block,
        counts: &Range<usize>,
        whole: bool,
    ) -> Option<Numbers<'t>> {
        let mut numbers = Numbers {
            values: [0.0; MOST_NUMBERS],
            tokens: Vec::with_capacity(3),
            extra: None,
            good: true,
        };
        let mut spaced = false;
        while self.window[0].kind == TokenKind::Word {
            let token = self.window[0];
            let count = numbers.tokens.len();
            // A word that is no number is a wrong value while values lack, unless it may be the next attribute.
            if !looks_numeric(token.text)
                && (count >= counts.start || self.may_be_attribute(block.entity))
            {
                break;
            }
            self.bump();
            if let Some(error) = common_mistakes::strange_space_error(token) {
                self.errors.report(error);
                give_rows_in(block, token);
                spaced = true;
                continue;
            }
            if count == counts.end - 1 {
                numbers.extra.get_or_insert((token.start, 0)).1 += 1;
                continue;
            }
            numbers.tokens.push(token);
            match read(token, whole) {
                Ok(value) => numbers.values[count] = value,
                Err(error) => {
                    self.errors.report(*error);
                    numbers.good = false;
                }
            }
        }
        (!spaced).then_some(numbers)
    }

    fn check_limit(&mut self, row: &Attribute, numbers: &Numbers<'t>, max: usize) -> bool {
        let tokens = &numbers.tokens;
        let mut broken = row.limit.broken(&numbers.values[..max]);
        // A single value that stands for three is reported once.
        broken.retain(|index| *index < tokens.len());
        let (Some(first), Some(last)) = (broken.first(), broken.last()) else {
            return true;
        };
        let message = format!("`{}` must be {}", row.name, row.limit.wording());
        let together = broken.len() == last - first + 1;
        let error = if together {
            Diagnostic::new(tokens[*first].start..tokens[*last].end(), message)
        } else {
            Diagnostic::new(tokens[*first].span(), message)
                .also(tokens[*last].span(), "and this one")
        };
        let error = match row.limit {
            // A colour below 0 is meant to take light away.
            Limit::NotNegative if max == 3 => {
                let kept = |(index, token): (usize, &Token<'_>)| {
                    let text = String::from_utf8_lossy(token.text);
                    if broken.contains(&index) {
                        "0".into()
                    } else {
                        text.into_owned()
                    }
                };
                let written: Vec<String> = tokens.iter().enumerate().map(kept).collect();
                let written = written.join(" ");
                error.help(format!(
                    "write `{written}`: light is added, and never taken away"
                ))
            }
            _ => error,
        };
        self.errors.report(error);
        false
    }
}

/// How many numbers an attribute takes, in words.
fn takes(counts: &Range<usize>) -> String {
    match counts.end - 1 {
        max if counts.start < max => String::from("1 or 3 numbers"),
        1 => String::from("1 number"),
        max => format!("{max} numbers"),
    }
}

/// What is wrong with the number of numbers; `span` is that of the attribute.
fn wrong_count(
    row: &Attribute,
    numbers: &Numbers<'_>,
    counts: &Range<usize>,
    span: Range<usize>,
) -> Diagnostic {
    let takes = takes(counts);
    let (span, label) = match numbers.extra {
        Some((start, _)) => (start..span.end, "too many"),
        None => (span, "too few"),
    };
    let (name, found) = (row.name, numbers.found());
    let error =
        Diagnostic::new(span, format!("`{name}` takes {takes}, found {found}")).label(label);
    if numbers.extra.is_some() || !row.is_colour() {
        return error;
    }
    match &numbers.tokens[..] {
        [one] if numbers.good => {
            let one = String::from_utf8_lossy(one.text);
            error.help(format!("a colour is red, green, blue: `{one} {one} {one}`"))
        }
        _ => error.help("a colour is red, green, blue"),
    }
}

/// Reads one number.
fn read(token: Token<'_>, whole: bool) -> Result<f64, Box<Diagnostic>> {
    let value = if whole {
        number::parse_integer(token.text).map(|value| value as f64)
    } else {
        number::parse_number(token.text)
    };
    if let Ok(value) = value {
        return Ok(value);
    }
    let word = token.quoted();
    let error = match number::parse_number(token.text) {
        Err(NumberError::NotFinite) => format!("{word} is not a finite number"),
        _ if whole => format!("{word} is not a whole number"),
        Err(NumberError::TooLarge) => {
            format!("{word} is too large a number: the largest is about 1.8e308")
        }
        _ => format!("{word} is not a number"),
    };
    let error = Diagnostic::new(token.span(), error);
    Err(Box::new(
        match common_mistakes::number_help(token.text, whole) {
            Some(help) => error.help(help),
            None => error,
        },
    ))
}
