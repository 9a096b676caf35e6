//! Exact numbers: rationals, and fields that grow out of them by up to six square roots (`MOST_ROOTS` in `decide`).
//!
//! K₀ = ℚ, K₍ᵢ₊₁₎ = Kᵢ(√cᵢ) with cᵢ > 0 in Kᵢ that has no root there. An element of K₍ᵢ₊₁₎ is a + b√cᵢ with a and b in
//! Kᵢ, in one way only; so it is 0 just if all coefficients are. That is what proves a tie.

use std::cell::Cell;
use std::cmp::Ordering;
use std::rc::Rc;

use dashu_base::BitTest;
use dashu_int::UBig;

use crate::real::rational::{self, Ratio};

/// A number of the tower.
#[derive(Debug, Clone)]
pub(super) enum Element {
    /// A rational number.
    Rational(Ratio),
    /// a + b√c, c the root adjoined as number `level` (from 1), a and b of lower levels, b not 0.
    Root(Rc<Rooted>),
}

/// a + b√c.
#[derive(Debug)]
pub(super) struct Rooted {
    level: usize,
    a: Element,
    b: Element,
}

/// Why there is no exact number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TooHard {
    /// It takes more roots.
    Roots,
    /// Its numbers have too many digits.
    Size,
    /// It has a cosine in it that no roots give.
    Opaque,
    /// It is divided by zero somewhere, or is the root of a negative number.
    Undefined,
}

type Exact = Result<Element, TooHard>;

/// The field.
#[derive(Debug, Default)]
pub(super) struct Tower {
    /// What the roots are roots of.
    squares: Vec<Element>,
    /// Products of words that may still be made.
    left: Cell<usize>,
}

/// Numerators and denominators beyond this are given up.
const MAX_BITS: usize = 100_000;
/// From here on a fraction is reduced.
const REDUCE_BITS: usize = 384;

fn held(value: Ratio) -> Exact {
    let bits = value.numerator().bit_len() + value.denominator().bit_len();
    if bits <= REDUCE_BITS {
        return Ok(Element::Rational(value));
    }
    let value = value.canonicalize().relax();
    if value.numerator().bit_len() + value.denominator().bit_len() > MAX_BITS {
        return Err(TooHard::Size);
    }
    Ok(Element::Rational(value))
}

impl Element {
    pub(super) fn zero() -> Self {
        Self::Rational(Ratio::ZERO)
    }

    pub(super) fn is_zero(&self) -> bool {
        matches!(self, Self::Rational(value) if value.is_zero())
    }

    pub(super) fn is_rational(&self) -> bool {
        matches!(self, Self::Rational(_))
    }

    fn level(&self) -> usize {
        match self {
            Self::Rational(_) => 0,
            Self::Root(r) => r.level,
        }
    }

    /// a + b√c of this level.
    fn of(level: usize, a: Self, b: Self) -> Self {
        if b.is_zero() {
            a
        } else {
            Self::Root(Rc::new(Rooted { level, a, b }))
        }
    }

    /// The coefficients at this level, which is the number's own or a higher one.
    fn split(&self, level: usize) -> (Self, Self) {
        match self {
            Self::Root(r) if r.level == level => (r.a.clone(), r.b.clone()),
            _ => (self.clone(), Self::zero()),
        }
    }

    pub(super) fn neg(&self) -> Self {
        match self {
            Self::Rational(value) => Self::Rational(-value.clone()),
            Self::Root(r) => Self::of(r.level, r.a.neg(), r.b.neg()),
        }
    }

    pub(super) fn add(&self, o: &Self) -> Exact {
        match (self, o) {
            (Self::Rational(x), Self::Rational(y)) => {
                if x.is_zero() {
                    return Ok(o.clone());
                }
                if y.is_zero() {
                    return Ok(self.clone());
                }
                held(x + y)
            }
            (Self::Root(x), Self::Root(y)) if x.level == y.level => {
                Ok(Self::of(x.level, x.a.add(&y.a)?, x.b.add(&y.b)?))
            }
            (Self::Root(x), _) if x.level > o.level() => {
                Ok(Self::of(x.level, x.a.add(o)?, x.b.clone()))
            }
            _ => o.add(self),
        }
    }

    pub(super) fn sub(&self, o: &Self) -> Exact {
        self.add(&o.neg())
    }
}

impl Tower {
    /// Begins a number, which may take so many products of words.
    pub(super) fn begin(&self, work: usize) {
        self.left.set(work);
    }

    /// How many may still be made.
    pub(super) fn left(&self) -> usize {
        self.left.get()
    }

    /// Counts the sum of two numbers, which is made without the tower.
    pub(super) fn spend_sum(&self, x: &Element, y: &Element) -> Result<(), TooHard> {
        match (x, y) {
            (Element::Rational(a), Element::Rational(b)) => self.spend(a, b),
            _ => Ok(()),
        }
    }

    fn spend(&self, a: &Ratio, b: &Ratio) -> Result<(), TooHard> {
        let words = |x: &Ratio| (x.numerator().bit_len() + x.denominator().bit_len()) / 64 + 1;
        let (a, b) = (words(a), words(b));
        // Reducing a fraction is what takes most.
        let reducing = if 64 * (a + b) > REDUCE_BITS {
            8 * (a + b) * (a + b)
        } else {
            0
        };
        let left = self.left.get().checked_sub(a * b + reducing);
        self.left.set(left.unwrap_or(0));
        left.map(|_| ()).ok_or(TooHard::Size)
    }

    /// How many roots have been adjoined.
    pub(super) fn height(&self) -> usize {
        self.squares.len()
    }

    pub(super) fn mul(&self, x: &Element, y: &Element) -> Exact {
        if x.is_zero() || y.is_zero() {
            return Ok(Element::zero());
        }
        match (x, y) {
            (Element::Rational(a), Element::Rational(b)) => {
                self.spend(a, b)?;
                held(a * b)
            }
            (Element::Root(p), Element::Root(q)) if p.level == q.level => {
                let c = &self.squares[p.level - 1];
                let bb = self.mul(&p.b, &q.b)?;
                let a = self.mul(&p.a, &q.a)?.add(&self.mul(&bb, c)?)?;
                let b = self.mul(&p.a, &q.b)?.add(&self.mul(&p.b, &q.a)?)?;
                Ok(Element::of(p.level, a, b))
            }
            (Element::Root(p), _) if p.level > y.level() => {
                Ok(Element::of(p.level, self.mul(&p.a, y)?, self.mul(&p.b, y)?))
            }
            _ => self.mul(y, x),
        }
    }

    /// 1/x = (a − b√c)/(a² − b²c). The norm is not 0, as c has no root below.
    fn inverse(&self, x: &Element) -> Exact {
        match x {
            Element::Rational(value) if value.is_zero() => Err(TooHard::Undefined),
            Element::Rational(value) => held(Ratio::ONE / value),
            Element::Root(r) => {
                let over = self.inverse(&self.norm(r)?)?;
                let a = self.mul(&r.a, &over)?;
                let b = self.mul(&r.b, &over)?.neg();
                Ok(Element::of(r.level, a, b))
            }
        }
    }

    /// a² − b²c.
    fn norm(&self, r: &Rooted) -> Exact {
        let bb = self.mul(&r.b, &r.b)?;
        self.mul(&r.a, &r.a)?
            .sub(&self.mul(&bb, &self.squares[r.level - 1])?)
    }

    pub(super) fn div(&self, x: &Element, y: &Element) -> Exact {
        if let (Element::Rational(a), Element::Rational(b)) = (x, y)
            && !b.is_zero()
        {
            self.spend(a, b)?;
            return held(a / b);
        }
        self.mul(x, &self.inverse(y)?)
    }

    pub(super) fn sign(&self, x: &Element) -> Result<Ordering, TooHard> {
        let r = match x {
            Element::Rational(value) => return Ok(value.cmp(&Ratio::ZERO)),
            Element::Root(r) => r,
        };
        let (a, b) = (self.sign(&r.a)?, self.sign(&r.b)?);
        if a == Ordering::Equal || a == b {
            return Ok(b);
        }
        // a and b√c have unlike signs, so the sign is that of the larger in absolute value.
        let norm = self.sign(&self.norm(r)?)?;
        Ok(if a == Ordering::Greater {
            norm
        } else {
            norm.reverse()
        })
    }

    /// The root that is not negative, in this field or, if that has none, in the field with it adjoined; `most` roots
    /// in all.
    pub(super) fn sqrt(&mut self, x: &Element, most: usize) -> Exact {
        match self.sign(x)? {
            Ordering::Less => return Err(TooHard::Undefined),
            Ordering::Equal => return Ok(Element::zero()),
            Ordering::Greater => {}
        }
        if let Some(root) = self.root_in(x, self.height())? {
            return Ok(if self.sign(&root)? == Ordering::Less {
                root.neg()
            } else {
                root
            });
        }
        if self.height() >= most {
            return Err(TooHard::Roots);
        }
        self.squares.push(x.clone());
        Ok(Element::of(
            self.height(),
            Element::zero(),
            Element::Rational(Ratio::ONE),
        ))
    }

    /// A root of `x` in the field of the first `level` roots.
    ///
    /// If a + b√c = (m + l√c)², then m² + l²c = a and 2ml = b. With b = 0 one of m and l is 0: a or a/c is a square.
    /// Else a² − b²c = (m² − l²c)² is a square n², and m² = (a ± n)/2.
    fn root_in(&self, x: &Element, level: usize) -> Result<Option<Element>, TooHard> {
        if let (Element::Rational(value), 0) = (x, level) {
            return Ok(rational::root(value).map(Element::Rational));
        }
        let (a, b) = x.split(level);
        let below = level - 1;
        let c = &self.squares[below];
        if b.is_zero() {
            if let Some(root) = self.root_in(&a, below)? {
                return Ok(Some(root));
            }
            let root = self.root_in(&self.div(&a, c)?, below)?;
            return Ok(root.map(|l| Element::of(level, Element::zero(), l)));
        }
        let bb = self.mul(&b, &b)?;
        let norm = self.mul(&a, &a)?.sub(&self.mul(&bb, c)?)?;
        let Some(n) = self.root_in(&norm, below)? else {
            return Ok(None);
        };
        let half = Element::Rational(Ratio::from_parts(1.into(), UBig::from(2_u8)));
        for n in [n.neg(), n] {
            let square = self.mul(&a.add(&n)?, &half)?;
            if let Some(m) = self.root_in(&square, below)? {
                let l = self.div(&self.mul(&b, &half)?, &m)?;
                return Ok(Some(Element::of(level, m, l)));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests;
