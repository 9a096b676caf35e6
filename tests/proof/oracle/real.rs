//! Exact real numbers as expressions: ratios, + − × ÷ √ and the cosines of angles, evaluated in balls of as many bits
//! as a question needs. Where balls cannot separate two numbers, `tower` decides exactly or the question stays
//! unresolved: near is never taken for equal.
//!
//! Stands between `ball` and `tower` below and the geometry of `hits` and `trace` above.

use std::cell::{Cell, RefCell};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::rc::Rc;

use dashu_int::IBig;
use dashu_ratio::RBig;

use super::angle;
use super::ball::Ball;
use super::tower::{self, Limits};

/// Bits of the evaluation that every expression gets at once; products of two such numbers fit in 128 bits.
pub(crate) const FIRST: usize = 60;

/// Bits of the evaluations that follow where a question is open, the exact tests of [`tower`] between them.
const NEXT: [usize; 3] = [192, 1024, 4096];

/// How far the exact test goes after each of [`NEXT`]: nearly all ties take one or two roots and no time.
const EXACT: [Limits; 3] = [
    Limits {
        roots: 2,
        work: 30_000_000,
    },
    Limits {
        roots: 5,
        work: 300_000_000,
    },
    Limits {
        roots: 7,
        work: 20_000_000_000,
    },
];

/// A question that neither 4,096 bits nor towers of roots decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unresolved;

/// How hard the questions of this thread were.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Effort {
    /// Questions that the first evaluation left open.
    pub(crate) open: u64,
    /// Of these, the ones that an exact test decided.
    pub(crate) exact: u64,
    /// Of these, the ones that were ties: the two sides were equal.
    pub(crate) ties: u64,
    /// Questions that needed more than the first of [`NEXT`].
    pub(crate) deep: u64,
}

thread_local! {
    static FIRST_BITS: Cell<usize> = const { Cell::new(FIRST) };
    static EFFORT: Cell<Effort> = const { Cell::new(Effort { open: 0, exact: 0, ties: 0, deep: 0 }) };
}

/// From now on, this thread evaluates new numbers at once in so many bits.
pub(crate) fn evaluate_first_in(bits: usize) {
    FIRST_BITS.set(bits);
}

/// What this thread's questions took since it was last asked.
pub(crate) fn take_effort() -> Effort {
    EFFORT.take()
}

fn count(change: impl FnOnce(&mut Effort)) {
    let mut effort = EFFORT.get();
    change(&mut effort);
    EFFORT.set(effort);
}

/// An exact real number.
#[derive(Debug, Clone)]
pub(crate) struct Real(Rc<Node>);

#[derive(Debug)]
struct Node {
    operation: Operation,
    first: Ball,
    /// The last evaluation with more bits, and how many.
    more: RefCell<Option<(usize, Ball)>>,
}

/// How a number is made of others.
#[derive(Debug)]
pub(crate) enum Operation {
    /// Known outright.
    Ratio(RBig),
    Sum(Real, Real),
    Difference(Real, Real),
    Product(Real, Real),
    Quotient(Real, Real),
    /// Of a number that is not negative.
    Root(Real),
    /// Of an angle in degrees that ruler and compass cannot make: no tower of roots holds it.
    Cosine(RBig),
}

impl Operation {
    fn evaluate(&self, bits: usize) -> Ball {
        match self {
            Self::Ratio(ratio) => Ball::ratio(ratio, bits),
            Self::Sum(a, b) => a.ball(bits).add(&b.ball(bits), bits),
            Self::Difference(a, b) => a.ball(bits).sub(&b.ball(bits), bits),
            Self::Product(a, b) => a.ball(bits).mul(&b.ball(bits), bits),
            Self::Quotient(a, b) => a.ball(bits).div(&b.ball(bits), bits),
            Self::Root(a) => a.ball(bits).sqrt(bits),
            Self::Cosine(degrees) => angle::cosine(degrees, bits),
        }
    }
}

impl Real {
    fn new(operation: Operation) -> Self {
        let first = operation.evaluate(FIRST_BITS.get());
        Self(Rc::new(Node {
            operation,
            first,
            more: RefCell::new(None),
        }))
    }

    /// Exactly the f64, which has to be finite.
    pub(crate) fn from_f64(number: f64) -> Self {
        Self::ratio(RBig::try_from(number).expect("a scene holds finite numbers"))
    }

    pub(crate) fn integer(number: i64) -> Self {
        Self::ratio(RBig::from(number))
    }

    pub(crate) fn ratio(ratio: RBig) -> Self {
        Self::new(Operation::Ratio(ratio))
    }

    /// The cosine of an angle that [`angle::constructed`] does not give.
    pub(crate) fn cosine(degrees: RBig) -> Self {
        Self::new(Operation::Cosine(degrees))
    }

    pub(crate) fn sqrt(&self) -> Self {
        if self.is(0) || self.is(1) {
            return self.clone();
        }
        Self::new(Operation::Root(self.clone()))
    }

    pub(crate) fn square(&self) -> Self {
        self * self
    }

    /// The same number, known outright if it is rational (and not very long).
    pub(crate) fn settled(self) -> Self {
        tower::rational(&self).map_or(self, Self::ratio)
    }

    pub(crate) fn operation(&self) -> &Operation {
        &self.0.operation
    }

    /// Which expression this is: the same for clones.
    pub(crate) fn identity(&self) -> usize {
        Rc::as_ptr(&self.0) as usize
    }

    /// Whether the first evaluation is exactly this whole number. (No says nothing.)
    fn is(&self, n: i64) -> bool {
        self.0.first.is_exactly(n)
    }

    fn ball(&self, bits: usize) -> Ball {
        if bits <= FIRST_BITS.get() || self.0.first.is_exact() {
            return self.0.first.clone();
        }
        if let Some((known, ball)) = &*self.0.more.borrow()
            && *known == bits
        {
            return ball.clone();
        }
        let ball = self.0.operation.evaluate(bits);
        *self.0.more.borrow_mut() = Some((bits, ball.clone()));
        ball
    }

    /// Less than, equal to or greater than zero.
    pub(crate) fn sign(&self) -> Result<Ordering, Unresolved> {
        match self.0.first.sign() {
            Some(sign) => Ok(sign),
            None => self.hard_sign(),
        }
    }

    fn hard_sign(&self) -> Result<Ordering, Unresolved> {
        count(|effort| effort.open += 1);
        for (step, (bits, limits)) in NEXT.into_iter().zip(EXACT).enumerate() {
            if step > 0 {
                count(|effort| effort.deep += u64::from(step == 1));
            }
            if let Some(sign) = self.ball(bits).sign() {
                return Ok(sign);
            }
            if let Some(sign) = tower::sign(self, limits) {
                count(|effort| {
                    effort.exact += 1;
                    effort.ties += u64::from(sign == Ordering::Equal);
                });
                return Ok(sign);
            }
        }
        Err(Unresolved)
    }

    pub(crate) fn is_positive(&self) -> Result<bool, Unresolved> {
        Ok(self.sign()? == Ordering::Greater)
    }

    pub(crate) fn is_zero(&self) -> Result<bool, Unresolved> {
        Ok(self.sign()? == Ordering::Equal)
    }

    /// Compares with another number.
    pub(crate) fn compare(&self, other: &Self) -> Result<Ordering, Unresolved> {
        if Rc::ptr_eq(&self.0, &other.0) {
            return Ok(Ordering::Equal);
        }
        match self.0.first.sub(&other.0.first, FIRST_BITS.get()).sign() {
            Some(sign) => Ok(sign),
            None => (self - other).hard_sign(),
        }
    }

    /// The largest whole number that is not larger.
    pub(crate) fn floor(&self) -> Result<IBig, Unresolved> {
        for (step, bits) in [FIRST_BITS.get()].into_iter().chain(NEXT).enumerate() {
            let Some((least, most)) = self.ball(bits).floors() else {
                continue;
            };
            if least == most {
                return Ok(least);
            }
            // Two whole parts that touch: which side of the one border?
            if step > 0 && &most - &least == IBig::ONE {
                let border = Self::ratio(RBig::from(most.clone()));
                return Ok(match self.compare(&border)? {
                    Ordering::Less => least,
                    _ => most,
                });
            }
        }
        Err(Unresolved)
    }

    /// floor(min(255, max(0, self))).
    pub(crate) fn byte(&self) -> Result<u8, Unresolved> {
        if let Some((least, most)) = self.0.first.floors() {
            let clamp = |n: IBig| u8::try_from(n.clamp(IBig::ZERO, IBig::from(255))).ok();
            if let (Some(least), Some(most)) = (clamp(least), clamp(most))
                && least == most
            {
                return Ok(least);
            }
        }
        if self.compare(&Self::integer(255))? != Ordering::Less {
            return Ok(255);
        }
        if self.compare(&Self::integer(1))? == Ordering::Less {
            return Ok(0);
        }
        Ok(u8::try_from(self.floor()?).expect("from 1 to below 255"))
    }

    /// The number to the power of `exponent`, both from 0: exponents are f64 and so whole multiples of powers of 2, and
    /// squares and square roots suffice. `self` is at most 1.
    pub(crate) fn power(&self, exponent: f64) -> Result<Self, Unresolved> {
        if self
            .0
            .first
            .sub(
                &Ball::integer(&IBig::ONE, FIRST_BITS.get()),
                FIRST_BITS.get(),
            )
            .sign()
            .is_none()
            && self.compare(&Self::integer(1))? == Ordering::Equal
        {
            return Ok(Self::integer(1));
        }
        let exponent = RBig::try_from(exponent).expect("a scene holds finite numbers");
        let (over, under) = exponent.into_parts();
        let whole = &over / IBig::from(under.clone());
        let mut rest = &over - &whole * IBig::from(under.clone());
        let mut result = Self::integer(1);
        let digits = whole.in_radix(2).to_string();
        for digit in digits.chars() {
            result = result.square();
            if digit == '1' {
                result = &result * self;
            }
        }
        let mut root = self.clone();
        while rest != IBig::ZERO {
            root = root.sqrt();
            rest *= 2;
            if rest >= IBig::from(under.clone()) {
                rest -= IBig::from(under.clone());
                result = &result * &root;
            }
        }
        Ok(result)
    }
}

impl Add for &Real {
    type Output = Real;
    fn add(self, other: Self) -> Real {
        if self.is(0) {
            return other.clone();
        }
        if other.is(0) {
            return self.clone();
        }
        Real::new(Operation::Sum(self.clone(), other.clone()))
    }
}

impl Sub for &Real {
    type Output = Real;
    fn sub(self, other: Self) -> Real {
        if other.is(0) {
            return self.clone();
        }
        if Rc::ptr_eq(&self.0, &other.0) {
            return Real::integer(0);
        }
        Real::new(Operation::Difference(self.clone(), other.clone()))
    }
}

impl Mul for &Real {
    type Output = Real;
    fn mul(self, other: Self) -> Real {
        if self.is(0) || other.is(1) {
            return self.clone();
        }
        if other.is(0) || self.is(1) {
            return other.clone();
        }
        Real::new(Operation::Product(self.clone(), other.clone()))
    }
}

impl Div for &Real {
    type Output = Real;
    /// By a number that is not zero.
    fn div(self, other: Self) -> Real {
        if self.is(0) || other.is(1) {
            return self.clone();
        }
        Real::new(Operation::Quotient(self.clone(), other.clone()))
    }
}

impl Neg for &Real {
    type Output = Real;
    fn neg(self) -> Real {
        &Real::integer(0) - self
    }
}
