//! The expressions of a thread: one node an operation, operands before their results.

use std::cell::RefCell;

use super::Lazy;
use super::ball::Ball;
use super::tower::{Element, Tower};
use crate::real::rational::Ratio;
use crate::real::{Bounded, Real};

/// How hard it was to decide what was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Effort {
    /// f64 enclosures were enough.
    #[default]
    Bounds,
    /// It took more digits, or exact arithmetic that found a difference.
    Precision,
    /// Two numbers were proven to be equal.
    Proven,
    /// Two numbers that agree to 1,024 bits were taken as equal, or there was no deciding at all.
    Presumed,
}

/// How far an arena was filled.
#[derive(Debug, Clone, Copy, Default)]
pub struct Mark(u32);

/// An operation. Operands have lower numbers.
#[derive(Debug, Clone)]
pub(super) enum Op {
    /// An f64.
    Number(f64),
    /// A rational number.
    Ratio(Box<Ratio>),
    Add(u32, u32),
    Sub(u32, u32),
    Mul(u32, u32),
    Div(u32, u32),
    Neg(u32),
    Sqrt(u32),
    /// The cosine of so many degrees, where no square roots give it.
    Cosine(f64),
    /// 1 less the cosine of so few degrees, likewise.
    Versine(f64),
    /// Not a number.
    Fault,
}

#[derive(Debug)]
pub(super) struct Node {
    pub(super) op: Op,
    /// When the node was last looked at.
    pub(super) seen: u32,
    pub(super) enclosure: Bounded,
    pub(super) known: Option<Box<Known>>,
}

/// What has been computed of a node.
#[derive(Debug, Default)]
pub(super) struct Known {
    /// An approximation, and the bits that it was asked for with; None where it cannot be had with these.
    pub(super) ball: Option<(usize, Option<Ball>)>,
    /// Its exact value, in the tower of this number.
    pub(super) exact: Option<(u32, Element)>,
}

#[derive(Debug, Default)]
pub(super) struct Arena {
    pub(super) nodes: Vec<Node>,
    pub(super) looks: u32,
    pub(super) tower: Tower,
    /// The number of the tower.
    pub(super) towers: u32,
    pub(super) effort: Effort,
    /// Exact numbers made since the effort was last asked for.
    pub(super) exact_made: usize,
    /// Words of balls computed since then.
    pub(super) words: usize,
    /// Words of balls, and products of words for exact numbers, since the thread began.
    pub(super) work: u64,
}

/// More nodes than this, 200 MB of them, are not made.
const MAX_NODES: usize = 1 << 22;

pub(super) const ZERO: Lazy = Lazy(0);
const ONE: Lazy = Lazy(1);
const FAULT: Lazy = Lazy(2);
/// How many nodes always are there.
const FIXED: usize = 3;

thread_local! {
    static ARENA: RefCell<Arena> = RefCell::new(Arena::new());
}

/// Calls `f` with the thread's arena.
#[inline]
pub(super) fn with<T>(f: impl FnOnce(&mut Arena) -> T) -> T {
    ARENA.with_borrow_mut(f)
}

const UNKNOWN: Bounded = Bounded {
    value: 0.0,
    error: f64::INFINITY,
};

impl Arena {
    fn new() -> Self {
        let mut arena = Self::default();
        arena.clear();
        arena
    }

    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.push(Op::Number(0.0), Bounded::exact(0.0));
        self.push(Op::Number(1.0), Bounded::exact(1.0));
        self.push(Op::Fault, UNKNOWN);
        self.new_tower();
    }

    pub(super) fn new_tower(&mut self) {
        self.tower = Tower::default();
        self.towers = self.towers.wrapping_add(1);
    }

    pub(super) fn mark(&self) -> Mark {
        Mark(self.nodes.len() as u32)
    }

    pub(super) fn release(&mut self, mark: Mark) {
        self.nodes.truncate((mark.0 as usize).max(FIXED));
    }

    pub(super) fn node(&self, x: Lazy) -> &Node {
        &self.nodes[x.0 as usize]
    }

    pub(super) fn enclosure(&self, x: Lazy) -> Bounded {
        self.node(x).enclosure
    }

    pub(super) fn note(&mut self, effort: Effort) {
        self.effort = self.effort.max(effort);
    }

    pub(super) fn push(&mut self, op: Op, enclosure: Bounded) -> Lazy {
        if self.nodes.len() >= MAX_NODES {
            self.note(Effort::Presumed);
            return FAULT;
        }
        self.nodes.push(Node {
            op,
            seen: 0,
            enclosure: if enclosure.error.is_nan() || !enclosure.value.is_finite() {
                UNKNOWN
            } else {
                enclosure
            },
            known: None,
        });
        Lazy((self.nodes.len() - 1) as u32)
    }

    pub(super) fn number(&mut self, value: f64) -> Lazy {
        if value == 0.0 {
            ZERO
        } else if value == 1.0 {
            ONE
        } else if value.is_finite() {
            self.push(Op::Number(value), Bounded::exact(value))
        } else {
            FAULT
        }
    }

    pub(super) fn ratio(&mut self, value: &Ratio) -> Lazy {
        let enclosure = Bounded::ratio(value);
        if enclosure.error == 0.0 {
            return self.number(enclosure.value);
        }
        self.push(Op::Ratio(Box::new(value.clone())), enclosure)
    }

    pub(super) fn add(&mut self, a: Lazy, b: Lazy) -> Lazy {
        if a == ZERO {
            return b;
        }
        if b == ZERO {
            return a;
        }
        if a == FAULT || b == FAULT {
            return FAULT;
        }
        let enclosure = self.enclosure(a) + self.enclosure(b);
        self.push(Op::Add(a.0, b.0), enclosure)
    }

    pub(super) fn sub(&mut self, a: Lazy, b: Lazy) -> Lazy {
        if b == ZERO {
            return a;
        }
        if a == FAULT || b == FAULT {
            return FAULT;
        }
        if a == b {
            return ZERO;
        }
        if a == ZERO {
            return self.neg(b);
        }
        let enclosure = self.enclosure(a) - self.enclosure(b);
        self.push(Op::Sub(a.0, b.0), enclosure)
    }

    pub(super) fn mul(&mut self, a: Lazy, b: Lazy) -> Lazy {
        if a == FAULT || b == FAULT {
            return FAULT;
        }
        if a == ZERO || b == ZERO {
            return ZERO;
        }
        if a == ONE {
            return b;
        }
        if b == ONE {
            return a;
        }
        let enclosure = self.enclosure(a) * self.enclosure(b);
        self.push(Op::Mul(a.0, b.0), enclosure)
    }

    pub(super) fn div(&mut self, a: Lazy, b: Lazy) -> Lazy {
        if a == FAULT || b == FAULT || b == ZERO {
            return FAULT;
        }
        if a == ZERO {
            return ZERO;
        }
        if b == ONE {
            return a;
        }
        let enclosure = self.enclosure(a) / self.enclosure(b);
        self.push(Op::Div(a.0, b.0), enclosure)
    }

    pub(super) fn neg(&mut self, a: Lazy) -> Lazy {
        if a == ZERO || a == FAULT {
            return a;
        }
        let enclosure = -self.enclosure(a);
        self.push(Op::Neg(a.0), enclosure)
    }

    pub(super) fn sqrt(&mut self, a: Lazy) -> Lazy {
        if a == ZERO || a == ONE || a == FAULT {
            return a;
        }
        let enclosure = self.enclosure(a).sqrt();
        self.push(Op::Sqrt(a.0), enclosure)
    }

    pub(super) fn pow(&mut self, x: Lazy, exponent: f64) -> Lazy {
        let (mut whole, mut part) = (exponent.trunc(), exponent.fract());
        let mut result = ONE;
        let mut square = x;
        while whole > 0.0 {
            if whole % 2.0 == 1.0 {
                result = self.mul(result, square);
            }
            whole = (whole / 2.0).floor();
            if whole > 0.0 {
                square = self.mul(square, square);
            }
        }
        let mut root = x;
        while part > 0.0 {
            root = self.sqrt(root);
            part *= 2.0;
            if part >= 1.0 {
                result = self.mul(result, root);
                part -= 1.0;
            }
        }
        result
    }
}
