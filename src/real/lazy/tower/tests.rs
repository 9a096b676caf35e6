//! Identities of square roots, and numbers that are no such identity.

use super::*;
use crate::real::rational::ratio;

fn number(value: f64) -> Element {
    Element::Rational(ratio(value))
}

/// An empty tower whose numbers may take any work.
fn unlimited() -> Tower {
    let tower = Tower::default();
    tower.begin(usize::MAX);
    tower
}

fn root(tower: &mut Tower, x: &Element) -> Element {
    tower.sqrt(x, 4).unwrap()
}

fn same(x: &Element, y: &Element) -> bool {
    x.sub(y).unwrap().is_zero()
}

#[test]
fn products_of_roots_are_roots_of_products() {
    let mut t = unlimited();
    let (two, three) = (root(&mut t, &number(2.0)), root(&mut t, &number(3.0)));
    let six = root(&mut t, &number(6.0));
    assert_eq!(t.height(), 2, "√6 is in ℚ(√2, √3)");
    assert!(same(&t.mul(&two, &three).unwrap(), &six));
    assert!(!same(
        &two.add(&three).unwrap(),
        &root(&mut t, &number(10.0))
    ));
    let eight = root(&mut t, &number(0.125));
    assert!(same(&t.mul(&eight, &number(4.0)).unwrap(), &two));
    assert_eq!(t.sqrt(&number(-1.0), 4).unwrap_err(), TooHard::Undefined);
}

#[test]
fn nested_roots_are_found_in_the_field() {
    let mut t = unlimited();
    let two = root(&mut t, &number(2.0));
    let nested = number(3.0)
        .add(&t.mul(&number(2.0), &two).unwrap())
        .unwrap();
    let found = root(&mut t, &nested);
    assert!(
        same(&found, &two.add(&number(1.0)).unwrap()),
        "√(3 + 2√2) = 1 + √2"
    );
    let three = root(&mut t, &number(3.0));
    let six = t.mul(&two, &three).unwrap();
    let nested = number(5.0)
        .add(&t.mul(&number(2.0), &six).unwrap())
        .unwrap();
    let found = root(&mut t, &nested);
    assert!(
        same(&found, &two.add(&three).unwrap()),
        "√(5 + 2√6) = √2 + √3"
    );
    assert_eq!(t.height(), 2);
    // √(5 − 2√6) = √3 − √2, which is positive.
    let nested = number(5.0)
        .sub(&t.mul(&number(2.0), &six).unwrap())
        .unwrap();
    let found = root(&mut t, &nested);
    assert!(same(&found, &three.sub(&two).unwrap()));
    // √(1 + √2) is new.
    root(&mut t, &number(1.0).add(&two).unwrap());
    assert_eq!(t.height(), 3);
}

#[test]
fn the_nested_root_may_come_first() {
    let mut t = unlimited();
    let six = root(&mut t, &number(6.0));
    let nested = number(5.0)
        .add(&t.mul(&number(2.0), &six).unwrap())
        .unwrap();
    let sum = root(&mut t, &nested);
    let two = root(&mut t, &number(2.0));
    let three = root(&mut t, &number(3.0));
    assert_eq!(t.height(), 2);
    assert!(same(&sum, &two.add(&three).unwrap()));
}

#[test]
fn signs_and_inverses_are_exact() {
    let mut t = unlimited();
    let roots = [2.0, 3.0, 5.0, 7.0].map(|n| root(&mut t, &number(n)));
    assert_eq!(t.sqrt(&number(11.0), 4).unwrap_err(), TooHard::Roots);
    let sum = roots
        .iter()
        .try_fold(number(-8.02), |sum, root| sum.add(root))
        .unwrap();
    // √2 + √3 + √5 + √7 = 8.0280…
    assert_eq!(t.sign(&sum).unwrap(), Ordering::Greater);
    let one = t.mul(&sum, &t.inverse(&sum).unwrap()).unwrap();
    assert!(same(&one, &number(1.0)));
    // (√2 + √3 + √5 + √7)² is a square again.
    let square = t.mul(&sum, &sum).unwrap();
    assert!(same(&root(&mut t, &square), &sum));
    assert!(!same(&square, &sum));
    // 665857/470832 is √2 to 12 digits, from above.
    let near = t
        .div(&number(665_857.0), &number(470_832.0))
        .unwrap()
        .sub(&roots[0])
        .unwrap();
    assert_eq!(t.sign(&near).unwrap(), Ordering::Greater);
    assert_eq!(t.inverse(&number(0.0)).unwrap_err(), TooHard::Undefined);
}
