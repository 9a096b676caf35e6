//! The exact sign of an expression, in a tower of square roots over the rationals: numbers a + b√c, where a, b and c
//! are numbers of the storey below.
//!
//! A root is adjoined without asking whether the storey below has it already. So a number may be written in more than
//! one way, and zero is found by its sign: of a + b√c the sign is that of a and b where they agree, else it takes that
//! of a² − b²c, one storey down. Nothing is assumed but c ≥ 0.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::rc::Rc;

use dashu_base::{BitTest, Sign, SquareRoot};
use dashu_ratio::RBig;

use super::real::{Operation, Real};

/// How much may go into an exact test before it gives up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Most roots adjoined.
    pub(crate) roots: usize,
    /// Most work, in what are about nanoseconds.
    pub(crate) work: u64,
}

/// A number of the tower.
#[derive(Debug, Clone, PartialEq)]
enum Number {
    Ratio(RBig),
    /// a + b√c, c the radicand of this storey (from 0), a and b of storeys below.
    Storey(usize, Rc<(Number, Number)>),
}

use Number::{Ratio, Storey};

impl Number {
    const ZERO: Self = Ratio(RBig::ZERO);

    /// The storey after its own.
    fn height(&self) -> usize {
        match self {
            Ratio(_) => 0,
            Storey(storey, _) => storey + 1,
        }
    }

    fn make(storey: usize, a: Self, b: Self) -> Self {
        if b == Self::ZERO {
            a
        } else {
            Storey(storey, Rc::new((a, b)))
        }
    }

    /// The parts a and b of a number as one of this storey.
    fn parts(&self, storey: usize) -> (Self, Self) {
        match self {
            Storey(own, parts) if *own == storey => (parts.0.clone(), parts.1.clone()),
            _ => (self.clone(), Self::ZERO),
        }
    }

    fn neg(&self) -> Self {
        match self {
            Ratio(ratio) => Ratio(-ratio.clone()),
            Storey(storey, parts) => Self::make(*storey, parts.0.neg(), parts.1.neg()),
        }
    }
}

/// The roots adjoined so far, and what it cost.
#[derive(Debug)]
struct Tower {
    radicands: Vec<Number>,
    limits: Limits,
    work: u64,
    known: HashMap<usize, Number>,
}

/// The sign of an expression, unless it goes beyond the limits or holds what no tower does.
pub(crate) fn sign(real: &Real, limits: Limits) -> Option<Ordering> {
    let mut tower = Tower::new(limits);
    let number = tower.number(real)?;
    tower.sign(&number)
}

/// The value of an expression without roots but rational ones.
pub(crate) fn rational(real: &Real) -> Option<RBig> {
    let limits = Limits {
        roots: 0,
        work: 300_000_000,
    };
    match Tower::new(limits).number(real)? {
        Ratio(ratio) => Some(ratio),
        Storey(..) => None,
    }
}

impl Tower {
    fn new(limits: Limits) -> Self {
        Self {
            radicands: Vec::new(),
            limits,
            work: 0,
            known: HashMap::new(),
        }
    }

    /// The expression as a number of the tower, which grows by the roots it needs.
    fn number(&mut self, real: &Real) -> Option<Number> {
        if let Some(number) = self.known.get(&real.identity()) {
            return Some(number.clone());
        }
        let number = match real.operation() {
            Operation::Ratio(ratio) => Ratio(ratio.clone()),
            Operation::Sum(a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                self.add(&a, &b)?
            }
            Operation::Difference(a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                self.add(&a, &b.neg())?
            }
            Operation::Product(a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                self.multiply(&a, &b)?
            }
            Operation::Quotient(a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                let inverse = self.invert(&b)?;
                self.multiply(&a, &inverse)?
            }
            Operation::Root(a) => {
                let a = self.number(a)?;
                self.root(a)?
            }
            Operation::Cosine(_) => return None,
        };
        self.known.insert(real.identity(), number.clone());
        Some(number)
    }

    /// A ratio that was just computed, unless it took too long in all.
    fn step(&mut self, ratio: RBig) -> Option<Number> {
        let bits = ratio.numerator().bit_len() + ratio.denominator().bit_len();
        let words = bits as u64 / 64;
        // The fraction is reduced by a gcd, which takes time with the square of the length.
        self.work += 200 + 3 * words * words;
        (self.work <= self.limits.work).then_some(Ratio(ratio))
    }

    fn add(&mut self, x: &Number, y: &Number) -> Option<Number> {
        if let (Ratio(x), Ratio(y)) = (x, y) {
            return self.step(x + y);
        }
        let storey = x.height().max(y.height()) - 1;
        let ((a, b), (c, d)) = (x.parts(storey), y.parts(storey));
        Some(Number::make(storey, self.add(&a, &c)?, self.add(&b, &d)?))
    }

    fn multiply(&mut self, x: &Number, y: &Number) -> Option<Number> {
        if let (Ratio(x), Ratio(y)) = (x, y) {
            return self.step(x * y);
        }
        if *x == Number::ZERO || *y == Number::ZERO {
            return Some(Number::ZERO);
        }
        let storey = x.height().max(y.height()) - 1;
        let ((a, b), (c, d)) = (x.parts(storey), y.parts(storey));
        let radicand = self.radicands[storey].clone();
        let mut bottom = self.multiply(&a, &c)?;
        let both = self.multiply(&b, &d)?;
        if both != Number::ZERO {
            let both = self.multiply(&both, &radicand)?;
            bottom = self.add(&bottom, &both)?;
        }
        let (ad, bc) = (self.multiply(&a, &d)?, self.multiply(&b, &c)?);
        let top = self.add(&ad, &bc)?;
        Some(Number::make(storey, bottom, top))
    }

    /// a² − b²c of a + b√c.
    fn norm(&mut self, storey: usize, a: &Number, b: &Number) -> Option<Number> {
        let radicand = self.radicands[storey].clone();
        let square = self.multiply(b, b)?;
        let taken = self.multiply(&square, &radicand)?;
        let square = self.multiply(a, a)?;
        self.add(&square, &taken.neg())
    }

    /// 1 over a number that is not zero.
    fn invert(&mut self, x: &Number) -> Option<Number> {
        match x {
            Ratio(ratio) => {
                let (over, under) = ratio.clone().into_parts();
                if over.is_zero() {
                    return None;
                }
                self.step(RBig::from_parts_signed(under.into(), over))
            }
            Storey(storey, parts) => {
                let (a, b) = (&parts.0, &parts.1);
                let norm = self.norm(*storey, a, b)?;
                if self.sign(&norm)? == Ordering::Equal {
                    // b√c is a or −a: the number is 2a, as it is not zero.
                    let double = self.add(a, a)?;
                    return self.invert(&double);
                }
                // (a − b√c)/(a² − b²c)
                let inverse = self.invert(&norm)?;
                let bottom = self.multiply(a, &inverse)?;
                let top = self.multiply(&b.neg(), &inverse)?;
                Some(Number::make(*storey, bottom, top))
            }
        }
    }

    /// The root of a number that is not negative.
    fn root(&mut self, x: Number) -> Option<Number> {
        if let Ratio(ratio) = &x {
            if let Some(root) = exact_root(ratio) {
                return self.step(root);
            }
            // √(q²c) = q√c of a root that is there.
            for storey in 0..self.radicands.len() {
                if let Ratio(radicand) = &self.radicands[storey]
                    && let Some(root) = exact_root(&(ratio / radicand))
                {
                    return Some(Number::make(storey, Number::ZERO, Ratio(root)));
                }
            }
        }
        let storey = match self.radicands.iter().position(|radicand| *radicand == x) {
            Some(storey) => storey,
            None if self.sign(&x)? == Ordering::Equal => return Some(Number::ZERO),
            None if self.radicands.len() == self.limits.roots => return None,
            None => {
                self.radicands.push(x);
                self.radicands.len() - 1
            }
        };
        Some(Number::make(storey, Number::ZERO, Ratio(RBig::ONE)))
    }

    fn sign(&mut self, x: &Number) -> Option<Ordering> {
        match x {
            Ratio(ratio) => Some(ratio.cmp(&RBig::ZERO)),
            Storey(storey, parts) => {
                let a = self.sign(&parts.0)?;
                let b = self.sign(&parts.1)?;
                // The radicand is more than 0: no other is adjoined.
                if a == b || b == Ordering::Equal {
                    return Some(a);
                }
                if a == Ordering::Equal {
                    return Some(b);
                }
                let norm = self.norm(*storey, &parts.0, &parts.1)?;
                Some(match self.sign(&norm)? {
                    // The larger in magnitude gives the sign: a for a positive norm.
                    Ordering::Greater => a,
                    Ordering::Equal => Ordering::Equal,
                    Ordering::Less => b,
                })
            }
        }
    }
}

/// The square root of a rational number that is the square of one.
fn exact_root(ratio: &RBig) -> Option<RBig> {
    let (sign, over) = ratio.numerator().clone().into_parts();
    if sign == Sign::Negative {
        return None;
    }
    let (above, below) = (over.sqrt(), ratio.denominator().sqrt());
    (&above * &above == over && &below * &below == *ratio.denominator())
        .then(|| RBig::from_parts(above.into(), below))
}
