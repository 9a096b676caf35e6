//! What is found late: that a device is wrong when others have brought everything, or when all went out.

use super::*;

/// A device that is overtaken at its second band, and the bag in which it is: its first band, with this byte changed,
/// and those of the others are brought.
fn overtaken(spoiled: bool, others: &[(Kind, Role)]) -> (Bag, usize, Vec<usize>) {
    let bag = Bag::new(WIDTH, 0..12, Some(4));
    let slow = bag.join(Device, Works);
    let others: Vec<usize> = others
        .iter()
        .map(|(kind, role)| bag.join(*kind, *role))
        .collect();
    let take = |me| bag.take(me, 4, u32::MAX, false);
    assert_eq!(take(slow), Taken::Rows(8..12));
    let mut first = finished(slow, 8..12);
    first.band.rgb[5] ^= u8::from(spoiled);
    bag.deliver(first.checked(1));
    assert_eq!(take(slow), Taken::Rows(4..8));
    assert_eq!(take(others[0]), Taken::Rows(0..4));
    bag.deliver(finished(others[0], 0..4));
    thread::sleep(Duration::from_millis(20));
    // It is busy with this one, which another one brings.
    assert_eq!(take(others[0]), Taken::Rows(4..8));
    bag.deliver(finished(others[0], 4..8));
    (bag, slow, others)
}

fn emitted(bag: &Bag) -> (Result<(), Error>, Vec<u8>) {
    let mut out = Vec::new();
    let ended = bag.emit(
        &mut |band: &Band| {
            out.extend_from_slice(&band.rgb);
            Ok(())
        },
        &mut Stopwatch::start(),
    );
    (ended, out)
}

/// Everything was brought, and the CPU is needed once more.
#[test]
fn the_cpu_stays_as_long_as_somebody_may_be_wrong() {
    let (bag, slow, others) = overtaken(true, &[(Cpu, Works)]);
    assert_eq!(bag.take(others[0], 4, u32::MAX, false), Taken::Later);
    bag.revoke(slow, "it was wrong");
    thread::scope(|scope| {
        scope.spawn(|| work(&bag, others[0], Manner::Works, 4));
        let (ended, out) = emitted(&bag);
        ended.unwrap();
        assert!(out == right(0..12));
    });
    assert_eq!(bag.activity(others[0]).tally.pixels(), 12 * 16);
}

/// Nobody stands by for a device that has nothing left to do.
#[test]
fn who_stands_by_hears_that_devices_are_done() {
    let (bag, slow, others) = overtaken(true, &[(Device, Works), (Cpu, StandsBy)]);
    assert_eq!(bag.take(others[0], 4, u32::MAX, true), Taken::End);
    bag.revoke(slow, "it was wrong");
    thread::scope(|scope| {
        scope.spawn(|| work(&bag, others[1], Manner::Works, 4));
        let (ended, out) = emitted(&bag);
        ended.unwrap();
        assert!(out == right(0..12));
    });
}

/// A picture that is whole may be wrong.
#[test]
fn who_is_wrong_when_all_went_out_makes_it_doubtful() {
    for spoiled in [false, true] {
        let (bag, slow, _) = overtaken(spoiled, &[(Cpu, Works)]);
        emitted(&bag).0.unwrap();
        assert!(bag.doubt().is_none());
        bag.revoke(slow, "it was wrong");
        assert!(matches!(bag.doubt(), Some(Error::Revoked(why)) if why == "it was wrong"));
    }
}

/// Another device may be of the same kind, and wrong in the same way: the CPU compares, though it stands by.
#[test]
fn only_the_cpu_compares() {
    let bag = Bag::new(WIDTH, 0..12, Some(4));
    let [wrong, like, cpu] = [(Device, Works), (Device, Works), (Cpu, StandsBy)]
        .map(|(kind, role)| bag.join(kind, role));
    let take = |me| bag.take(me, 4, u32::MAX, false);
    let spoiled = |me, rows| {
        let mut band = finished(me, rows);
        band.band.rgb[5] ^= 1;
        band.checked(1)
    };
    assert_eq!(take(wrong), Taken::Rows(8..12));
    bag.deliver(spoiled(wrong, 8..12));
    let out = AtomicUsize::new(0);
    thread::scope(|scope| {
        scope.spawn(|| {
            while out.load(Ordering::SeqCst) < 1 {
                thread::yield_now();
            }
            assert_eq!(take(cpu), Taken::Later);
            assert_eq!(take(wrong), Taken::Rows(4..8));
            bag.revoke(wrong, "it was wrong");
            assert_eq!(take(like), Taken::Rows(4..8));
            assert_eq!(take(like), Taken::Rows(0..4));
            assert_eq!(take(like), Taken::Later);
            assert_eq!(take(cpu), Taken::Rows(8..12));
            bag.deliver(finished(cpu, 8..12));
        });
        let count = &mut |_: &Band| {
            out.fetch_add(1, Ordering::SeqCst);
            Ok(())
        };
        let ended = bag.emit(count, &mut Stopwatch::start());
        assert!(matches!(ended, Err(Error::Revoked(_))), "{ended:?}");
    });
}

/// While a driver gets ready it has all cores, for as long as was said; then the CPU goes on, and what it was seen to
/// do before is what the one on trial has to beat.
#[test]
fn the_cpu_rests_while_another_one_gets_ready() {
    let bag = Bag::new(WIDTH, 0..12, Some(4));
    let [cpu, device] = [(Cpu, Works), (Device, OnTrial)].map(|(kind, role)| bag.join(kind, role));
    let take = |me| bag.take(me, 4, u32::MAX, false);
    bag.expect(Some(0.5));
    bag.rest(Duration::from_secs(60), 1e-3);
    assert_eq!(take(cpu), Taken::Later);
    assert_eq!(take(device), Taken::Rows(8..12));
    bag.deliver(finished(device, 8..12));
    assert_eq!(take(device), Taken::Rows(4..8));
    assert_eq!(take(device), Taken::Rows(0..4), "it was quicker at once");
    let bag = Bag::new(WIDTH, 0..12, Some(4));
    let cpu = bag.join(Cpu, Works);
    bag.expect(Some(0.5));
    bag.rest(Duration::ZERO, 1e-3);
    assert_eq!(bag.take(cpu, 4, u32::MAX, false), Taken::Rows(8..12));
    // It will not come.
    bag.rest(Duration::from_secs(60), 1e-3);
    bag.expect(None);
    assert_eq!(bag.take(cpu, 4, u32::MAX, false), Taken::Rows(4..8));
}

/// Who is on trial makes a band alone after its first one, and if it leaves with it the others go on.
#[test]
fn a_trial_that_is_left_is_over() {
    let bag = Bag::new(WIDTH, 0..1000, Some(4));
    let [tried, cpu] = [(Device, OnTrial), (Cpu, Works)].map(|(kind, role)| bag.join(kind, role));
    let take = |me| bag.take(me, 4, u32::MAX, false);
    assert_eq!(take(cpu), Taken::Rows(996..1000));
    assert_eq!(take(tried), Taken::Rows(992..996));
    thread::sleep(Duration::from_millis(1));
    bag.deliver(finished(cpu, 996..1000));
    bag.deliver(finished(tried, 992..996));
    assert_eq!(take(cpu), Taken::Later);
    assert_eq!(take(tried), Taken::Rows(988..992));
    assert_eq!(take(cpu), Taken::Later);
    bag.leave(tried);
    assert_eq!(take(cpu), Taken::Rows(988..992));
}
