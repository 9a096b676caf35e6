//! Workers of all kinds share a picture whose bytes are known; what they do wrong is noticed, and loses nothing.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use super::*;
use crate::certify::{DecidedBy, Tally};
use crate::frame::{Band, PixelFault};

const WIDTH: u32 = 16;

/// The bytes of a row: no two rows of a picture have the same.
fn row(y: u32) -> Vec<u8> {
    (0..3 * WIDTH)
        .map(|i| (y.wrapping_mul(2_654_435_761).rotate_left(i) % 251) as u8)
        .collect()
}

fn band(rows: Range<u32>) -> Band {
    Band {
        rgb: rows.clone().rev().flat_map(row).collect(),
        rows,
        values: None,
        verdicts: None,
    }
}

fn finished(worker: usize, rows: Range<u32>) -> Finished {
    let mut tally = Tally::default();
    tally.add(DecidedBy::Single, u64::from(WIDTH) * rows.len() as u64);
    Finished::new(worker, band(rows), tally)
}

/// What a worker does with its bands.
#[derive(Debug, Clone, Copy)]
enum Manner {
    Works,
    /// It takes so long for a row.
    Slow(Duration),
    /// It leaves with its band after so many others.
    Leaves(u32),
    /// It has a wrong byte in every band, which is noticed after so many of them.
    Wrong(u32),
    /// It keeps its band for ever.
    Hangs,
}

fn work(bag: &Bag, me: usize, manner: Manner, wish: u32) {
    bag.ready(me);
    let mut done = 0;
    while let Taken::Rows(rows) = bag.take(me, wish, u32::MAX, true) {
        match manner {
            Manner::Works => bag.deliver(finished(me, rows)),
            Manner::Slow(time) => {
                thread::sleep(time * rows.len() as u32);
                bag.deliver(finished(me, rows));
            }
            Manner::Leaves(after) if done == after => {
                bag.leave(me);
                return;
            }
            Manner::Leaves(_) => bag.deliver(finished(me, rows).checked(1)),
            Manner::Wrong(after) if done == after => {
                bag.revoke(me, "it was wrong");
                return;
            }
            Manner::Wrong(_) => {
                let mut wrong = finished(me, rows);
                wrong.band.rgb[0] ^= 1;
                bag.deliver(wrong.checked(1));
            }
            Manner::Hangs => {
                while !bag.is_over() {
                    thread::sleep(Duration::from_millis(1));
                }
                return;
            }
        }
        done += 1;
    }
}

/// What comes out of a bag: the rows in order, or an error, and how many rows went out before.
fn run(
    rows: Range<u32>,
    workers: &[(Kind, Role, Manner)],
) -> (Result<(), Error>, Vec<u8>, Vec<Activity>) {
    let bag = Bag::new(WIDTH, rows.clone(), None);
    let mut out = Vec::new();
    let mut top = rows.end;
    let numbers: Vec<usize> = workers
        .iter()
        .map(|(kind, role, _)| bag.join(*kind, *role))
        .collect();
    let ended = thread::scope(|scope| {
        for (me, (_, _, manner)) in numbers.iter().zip(workers) {
            let bag = &bag;
            scope.spawn(move || work(bag, *me, *manner, 3 + *me as u32));
        }
        bag.emit(
            &mut |band: &Band| {
                assert_eq!(band.rows.end, top, "bands go out in order");
                top = band.rows.start;
                out.extend_from_slice(&band.rgb);
                Ok(())
            },
            &mut Stopwatch::start(),
        )
    });
    let activities = numbers.iter().map(|me| bag.activity(*me)).collect();
    (ended, out, activities)
}

fn right(rows: Range<u32>) -> Vec<u8> {
    rows.rev().flat_map(row).collect()
}

fn pixels(activities: &[Activity]) -> u64 {
    activities
        .iter()
        .map(|activity| activity.tally.pixels())
        .sum()
}

use Kind::{Cpu, Device};
use Role::{OnTrial, StandsBy, Works};

#[test]
fn any_workers_make_the_same_rows() {
    let quick = Manner::Works;
    let slow = Manner::Slow(Duration::from_micros(300));
    for workers in [
        &[(Cpu, Works, quick)][..],
        &[
            (Cpu, Works, quick),
            (Device, Works, quick),
            (Device, Works, slow),
        ],
        &[(Cpu, Works, slow), (Device, Works, quick)],
        &[(Cpu, StandsBy, quick), (Device, Works, slow)],
        &[(Cpu, Works, slow), (Device, OnTrial, quick)],
        &[(Cpu, Works, quick), (Device, OnTrial, slow)],
        &[
            (Cpu, Works, quick),
            (Device, Works, Manner::Leaves(0)),
            (Device, Works, Manner::Leaves(3)),
        ],
        &[(Cpu, StandsBy, quick), (Device, Works, Manner::Leaves(2))],
        &[(Cpu, Works, quick), (Device, OnTrial, Manner::Leaves(0))],
        &[(Cpu, Works, quick), (Device, OnTrial, Manner::Leaves(1))],
    ] {
        for rows in [0..1, 7..8, 0..500, 20..333] {
            let (ended, out, activities) = run(rows.clone(), workers);
            ended.unwrap();
            assert!(out == right(rows.clone()), "{workers:?}, {rows:?}");
            assert_eq!(
                pixels(&activities),
                u64::from(WIDTH) * rows.len() as u64,
                "{workers:?}"
            );
        }
    }
}

/// Whoever stands by gets nothing while others work, and all that they leave.
#[test]
fn who_stands_by_makes_what_others_leave() {
    let (ended, out, activities) = run(
        0..100,
        &[
            (Cpu, StandsBy, Manner::Works),
            (Device, Works, Manner::Works),
        ],
    );
    ended.unwrap();
    assert!(out == right(0..100));
    assert_eq!(activities[0].bands, 0);
    let (ended, out, activities) = run(
        0..100,
        &[
            (Cpu, StandsBy, Manner::Works),
            (Device, Works, Manner::Leaves(2)),
        ],
    );
    ended.unwrap();
    assert!(out == right(0..100));
    assert_eq!(activities[1].bands, 2);
    assert_eq!(activities[0].tally.pixels(), 100 * 16 - 2 * 4 * 16);
}

/// A band that hangs at its worker is made by another one; what comes too late counts for nothing.
#[test]
fn a_slow_worker_is_overtaken() {
    let late = Manner::Slow(Duration::from_millis(60));
    for slow in [Manner::Hangs, late] {
        let started = Instant::now();
        let (ended, out, activities) = run(
            0..200,
            &[(Cpu, Works, Manner::Works), (Device, Works, slow)],
        );
        ended.unwrap();
        assert!(out == right(0..200));
        assert_eq!(pixels(&activities), 200 * 16);
        assert_eq!(activities[1].bands, 0, "{slow:?}");
        assert!(started.elapsed() < Duration::from_secs(20));
    }
}

/// Wrong rows that went out cannot be taken back: that is an error, and so it is noticed. Those that did not go out
/// are made again.
#[test]
fn rows_of_a_wrong_worker_are_compared_or_made_again() {
    let bag = Bag::new(WIDTH, 0..12, Some(4));
    let (cpu, device) = (bag.join(Cpu, StandsBy), bag.join(Device, Works));
    bag.ready(device);
    let take = |me| match bag.take(me, 4, u32::MAX, false) {
        Taken::Rows(rows) => rows,
        other => panic!("{other:?}"),
    };
    let bands: Vec<_> = (0..3).map(|_| take(device)).collect();
    assert_eq!(bands, [8..12, 4..8, 0..4]);
    for spoiled in [false, true] {
        let bag = Bag::new(WIDTH, 0..12, Some(4));
        assert_eq!(
            (bag.join(Cpu, StandsBy), bag.join(Device, Works)),
            (cpu, device)
        );
        let take = |me| bag.take(me, 4, u32::MAX, false);
        let (emitted, all) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let ended = thread::scope(|scope| {
            scope.spawn(|| {
                assert_eq!(take(cpu), Taken::Later);
                assert_eq!(take(device), Taken::Rows(8..12));
                let mut first = finished(device, 8..12);
                first.band.rgb[5] ^= u8::from(spoiled);
                bag.deliver(first.checked(1));
                while emitted.load(Ordering::SeqCst) < 1 {
                    thread::yield_now();
                }
                assert_eq!(take(device), Taken::Rows(4..8));
                assert_eq!(take(device), Taken::Rows(0..4));
                // This one waits for the one above it, and never goes out.
                let mut below = finished(device, 0..4);
                below.band.rgb[0] ^= 1;
                bag.deliver(below.checked(1));
                bag.revoke(device, "it was wrong");
                assert_eq!(take(device), Taken::End);
                // What went out comes first.
                assert_eq!(take(cpu), Taken::Rows(8..12));
                bag.deliver(finished(cpu, 8..12));
                if !spoiled {
                    assert_eq!(take(cpu), Taken::Rows(4..8));
                    bag.deliver(finished(cpu, 4..8));
                    assert_eq!(take(cpu), Taken::Rows(0..4));
                    bag.deliver(finished(cpu, 0..4));
                }
            });
            bag.emit(
                &mut |band: &Band| {
                    all.lock().unwrap().extend_from_slice(&band.rgb);
                    emitted.fetch_add(1, Ordering::SeqCst);
                    Ok(())
                },
                &mut Stopwatch::start(),
            )
        });
        if spoiled {
            assert!(
                matches!(&ended, Err(Error::Revoked(why)) if why == "it was wrong"),
                "{ended:?}"
            );
        } else {
            ended.unwrap();
            assert!(*all.lock().unwrap() == right(0..12));
            assert_eq!(bag.activity(device).tally.pixels(), 0);
            assert_eq!(bag.activity(cpu).tally.pixels(), 12 * 16);
        }
    }
}

#[test]
fn whatever_a_wrong_worker_did_the_rows_are_right_or_it_is_an_error() {
    for after in 0..6 {
        for _ in 0..20 {
            let workers = [
                (Cpu, StandsBy, Manner::Works),
                (Device, Works, Manner::Wrong(after)),
            ];
            let (ended, out, activities) = run(0..60, &workers);
            match ended {
                Ok(()) => {
                    assert!(out == right(0..60));
                    assert_eq!(activities[1].bands, 0);
                }
                Err(error) => assert!(matches!(error, Error::Revoked(_)), "{error:?}"),
            }
        }
    }
}

/// Of several pixels that need too many rays the uppermost is named, whoever found it first.
#[test]
fn the_uppermost_fault_counts() {
    let bag = Bag::new(WIDTH, 0..12, Some(4));
    let worker = bag.join(Cpu, Works);
    for _ in 0..3 {
        assert!(matches!(
            bag.take(worker, 4, u32::MAX, false),
            Taken::Rows(_)
        ));
    }
    let fault = |y| {
        Halt::TooManyRays(PixelFault {
            x: 1,
            y,
            max_rays: 9,
        })
    };
    bag.halt(&(0..4), fault(2));
    bag.halt(&(4..8), fault(6));
    bag.deliver(finished(worker, 8..12));
    let mut rows = 0;
    let ended = bag.emit(
        &mut |band: &Band| {
            rows += band.rows.len();
            Ok(())
        },
        &mut Stopwatch::start(),
    );
    assert!(
        matches!(ended, Err(Error::TooManyRays(PixelFault { y: 6, .. }))),
        "{ended:?}"
    );
    assert_eq!(rows, 4);
    assert_eq!(bag.take(worker, 4, u32::MAX, true), Taken::End);
}

/// What is made ahead is bounded: the bands of a picture whose first one is slow.
#[test]
fn no_more_than_a_window_is_made_ahead() {
    let bag = Bag::new(1 << 20, 0..1000, Some(1));
    let worker = bag.join(Cpu, Works);
    let mut taken = 0;
    while let Taken::Rows(_) = bag.take(worker, 1, u32::MAX, false) {
        taken += 1;
    }
    assert_eq!(taken, 6);
}

#[test]
fn an_error_of_whoever_takes_the_bands_ends_it() {
    let bag = Bag::new(WIDTH, 0..100, None);
    let worker = bag.join(Cpu, Works);
    let ended = thread::scope(|scope| {
        scope.spawn(|| work(&bag, worker, Manner::Works, 5));
        bag.emit(
            &mut |_| Err(std::io::Error::other("full")),
            &mut Stopwatch::start(),
        )
    });
    assert!(matches!(ended, Err(Error::Emit(_))), "{ended:?}");
}
