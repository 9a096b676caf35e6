//! Deciding the sign of an expression whose f64 enclosure does not tell.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::arena::{Arena, Effort, Node, Op, ZERO};
use super::ball::Ball;
use super::tower::{Element, TooHard};
use super::{Lazy, cosine};
use crate::real::rational::{Ratio, ratio};
use crate::real::{Bounded, Real, Undecided};

/// The precisions, in bits, in which an expression is computed.
const BITS: [usize; 4] = [128, 256, 512, 1024];
/// And then, where it is not large: what is near to the size of 1 and what is near to that of the smallest f64 differ
/// in 1,074 bits, and a square of the one from a square of the other in twice as many.
const MORE_BITS: [usize; 2] = [2560, 8192];
/// Nodes of an expression that is not large.
const MEDIUM: usize = 1 << 14;
/// A number that is known not to be 0 is computed on and on; this is far beyond where one of ours ends.
const MOST_BITS: usize = 1 << 17;
/// Roots in an exact number: at once, and where 128 bits do not decide.
const FEW_ROOTS: usize = 2;
const MOST_ROOTS: usize = 6;
/// Expressions with more nodes than this are not computed: their numbers would take some hundred megabytes.
const LARGEST: usize = 1 << 20;
/// So many words of balls are computed for a pixel: some seconds. Then it is not decided.
const MOST_WORDS: usize = 1 << 26;
/// Expressions larger than this, or with more roots, are not tried exactly at once.
const SMALL: usize = 400;
/// Products of words that an exact number may take: at once, which is about as much as computing it in balls, and where
/// balls do not decide, some hundredths of a second.
const FEW_PRODUCTS: usize = 1 << 14;
const MOST_PRODUCTS: usize = 1 << 23;
/// So many exact numbers are made for a pixel: about a second. Then bits alone decide, and ties are presumed.
const MOST_EXACT: usize = 100_000;
const SMALL_ROOTS: usize = 6;

/// The operands of a node, the first and the second.
fn operands(op: &Op) -> [Option<u32>; 2] {
    match *op {
        Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) => [Some(a), Some(b)],
        Op::Neg(a) | Op::Sqrt(a) => [Some(a), None],
        Op::Number(_) | Op::Ratio(_) | Op::Cosine(_) | Op::Versine(_) | Op::Fault => [None, None],
    }
}

/// Whether a node has been computed in so many bits or more.
fn has(node: &Node, bits: usize) -> bool {
    let known = node.known.as_ref();
    known
        .and_then(|known| known.ball.as_ref())
        .is_some_and(|&(has, _)| has >= bits)
}

impl Arena {
    /// The sign of a number, proven; or presumed to be that of 0, which is noted.
    pub(super) fn sign(&mut self, x: Lazy) -> Result<Ordering, Undecided> {
        let node = self.node(x);
        if let Ok(sign) = node.enclosure.sign() {
            if sign == Ordering::Equal && x != ZERO {
                self.note(Effort::Proven);
            }
            return Ok(sign);
        }
        if matches!(node.op, Op::Fault) {
            return Err(Undecided);
        }
        self.note(Effort::Precision);
        let too_large = self.nodes.len() > LARGEST && self.below(x.0, |_| false).len() > LARGEST;
        if too_large || self.words > MOST_WORDS {
            self.note(Effort::Presumed);
            return Err(Undecided);
        }
        let (nodes, roots) = self.size(x);
        let mut long = false;
        if nodes <= SMALL && roots <= SMALL_ROOTS {
            match self.exact(x, FEW_ROOTS, FEW_PRODUCTS) {
                Ok(value) => return self.settle(x, &value),
                Err(fault) => long = fault == TooHard::Size,
            }
        }
        // What 128 bits leave open is a tie almost always; but numbers that are long, as those of unlike sizes are,
        // take exact arithmetic much longer than more bits, and these may well tell.
        let before_exact = BITS[if long { BITS.len() - 1 } else { 0 }];
        let mut why = None;
        for bits in BITS {
            if let Some(sign) = self.ball(x, bits).and_then(|ball| ball.sign()) {
                return Ok(sign);
            }
            if bits == before_exact {
                match self.exact(x, MOST_ROOTS, MOST_PRODUCTS) {
                    Ok(value) => return self.settle(x, &value),
                    Err(fault) => why = Some(fault),
                }
            }
        }
        if why == Some(TooHard::Undefined) {
            return Err(Undecided);
        }
        let last = if self.never_zero(x) {
            MOST_BITS
        } else if self.is_medium(x) {
            MORE_BITS[1]
        } else {
            0
        };
        let mut bits = MORE_BITS[0];
        while bits <= last {
            if let Some(sign) = self.ball(x, bits).and_then(|ball| ball.sign()) {
                return Ok(sign);
            }
            bits = if bits < MORE_BITS[1] {
                MORE_BITS[1]
            } else {
                2 * bits
            };
        }
        self.note(Effort::Presumed);
        self.set_zero(x);
        Ok(Ordering::Equal)
    }

    /// The sign of an exact number, which from now on is known of the node.
    fn settle(&mut self, x: Lazy, value: &Element) -> Result<Ordering, Undecided> {
        if value.is_zero() {
            self.note(Effort::Proven);
            self.set_zero(x);
            return Ok(Ordering::Equal);
        }
        self.tower.begin(MOST_PRODUCTS);
        match self.tower.sign(value) {
            Ok(sign) => Ok(sign),
            // It is not 0, so some precision tells its sign.
            Err(_) => (0..)
                .map(|i| BITS[0] << i)
                .take_while(|&bits| bits <= MOST_BITS)
                .find_map(|bits| self.ball(x, bits).and_then(|ball| ball.sign()))
                .ok_or(Undecided),
        }
    }

    /// Whether the expression is small enough for many bits.
    fn is_medium(&mut self, x: Lazy) -> bool {
        self.below_to(x.0, MEDIUM, |_| false).len() <= MEDIUM
    }

    fn set_zero(&mut self, x: Lazy) {
        let node = &mut self.nodes[x.0 as usize];
        node.op = Op::Number(0.0);
        node.enclosure = Bounded::exact(0.0);
        node.known = None;
    }

    /// Whether the number is the difference of one made by square roots and a cosine that cannot be made by so many.
    fn never_zero(&mut self, x: Lazy) -> bool {
        let Op::Sub(a, b) = self.node(x).op else {
            return false;
        };
        let (Op::Cosine(angle) | Op::Versine(angle)) = self.nodes[b as usize].op else {
            return false;
        };
        let mut roots = 0;
        for i in self.below(a, |_| false) {
            match self.nodes[i as usize].op {
                Op::Cosine(_) | Op::Versine(_) => return false,
                Op::Sqrt(_) => roots += 1,
                _ => {}
            }
        }
        cosine::roots(angle).is_none_or(|halvings| roots + 1 < halvings)
    }

    /// The f64 enclosure of a number whose floor is asked for. That it is an integer is a tie.
    pub(super) fn clear_of_integers(&mut self, x: Lazy) -> Option<Bounded> {
        let enclosure = self.enclosure(x);
        if enclosure.error == 0.0 && enclosure.value.fract() == 0.0 && x != ZERO {
            self.note(Effort::Proven);
        }
        enclosure.error.is_finite().then_some(enclosure)
    }

    /// The largest integer that is not above the number.
    pub(super) fn floor(&mut self, x: Lazy) -> Result<IBig, Undecided> {
        if matches!(self.node(x).op, Op::Fault) {
            return Err(Undecided);
        }
        let enclosure = self.enclosure(x);
        let small = enclosure.error < 0.25 && enclosure.value.abs() < (1_u64 << 51) as f64;
        let whole = if small {
            Some(IBig::from(enclosure.value.round() as i64))
        } else {
            let more = if self.is_medium(x) {
                &MORE_BITS[..]
            } else {
                &[]
            };
            BITS.iter()
                .chain(more)
                .find_map(|&bits| self.ball(x, bits).and_then(|ball| ball.integer()))
        };
        let whole = whole.ok_or(Undecided)?;
        let border = self.ratio(&Ratio::from(whole.clone()));
        let above = self.sub(x, border);
        Ok(match self.sign(above)? {
            Ordering::Less => whole - IBig::ONE,
            _ => whole,
        })
    }

    /// The f64 enclosure, made narrower than this share of the number if it can be.
    pub(super) fn narrow(&mut self, x: Lazy, share: f64) -> Bounded {
        // An error below 10⁻³⁰ of the viewpoint's distance does not matter to a caller that asks for f64.
        let wide = |enclosure: Bounded| {
            enclosure.error > share * enclosure.value.abs() && enclosure.error > 1e-30
                || enclosure.error.is_nan()
        };
        if self.nodes.len() > LARGEST {
            return self.enclosure(x);
        }
        for bits in BITS {
            if !wide(self.enclosure(x)) || matches!(self.node(x).op, Op::Fault) {
                break;
            }
            self.ball(x, bits);
        }
        self.enclosure(x)
    }

    /// The number in so many bits or more.
    pub(super) fn ball(&mut self, x: Lazy, bits: usize) -> Option<Ball> {
        let order = self.below(x.0, |node| has(node, bits));
        if order.len() > LARGEST {
            return None;
        }
        for i in order {
            if has(&self.nodes[i as usize], bits) {
                continue;
            }
            self.words += bits / 64;
            self.work += bits as u64 / 64;
            let ball = self.compute(i, bits);
            let node = &mut self.nodes[i as usize];
            if let Some(ball) = &ball {
                let enclosure = ball.bounded();
                if enclosure.error < node.enclosure.error && enclosure.value.is_finite() {
                    node.enclosure = enclosure;
                }
            }
            node.known.get_or_insert_default().ball = Some((bits, ball));
        }
        self.known_ball(x.0)
    }

    fn known_ball(&self, i: u32) -> Option<Ball> {
        let known = self.nodes[i as usize].known.as_ref()?;
        known.ball.as_ref()?.1.clone()
    }

    /// A node from its operands' balls.
    fn compute(&self, i: u32, bits: usize) -> Option<Ball> {
        let of = |i: u32| {
            let known = self.nodes[i as usize].known.as_ref()?;
            known.ball.as_ref()?.1.as_ref()
        };
        match &self.nodes[i as usize].op {
            Op::Number(value) => Some(Ball::exact(*value)),
            Op::Ratio(value) => Ball::ratio(value, bits),
            Op::Add(a, b) => of(*a)?.add(of(*b)?, bits),
            Op::Sub(a, b) => of(*a)?.add(&of(*b)?.neg(), bits),
            Op::Mul(a, b) => of(*a)?.mul(of(*b)?, bits),
            Op::Div(a, b) => of(*a)?.div(of(*b)?, bits),
            Op::Neg(a) => Some(of(*a)?.neg()),
            Op::Sqrt(a) => of(*a)?.sqrt(bits),
            Op::Cosine(angle) => Some(cosine::cosine(*angle, bits)),
            Op::Versine(angle) => Some(cosine::versine(*angle, bits)),
            Op::Fault => None,
        }
    }

    /// All nodes below `root` and itself, operands first; nodes for which `known` holds are not looked into.
    fn below(&mut self, root: u32, known: impl Fn(&Node) -> bool) -> Vec<u32> {
        self.below_to(root, usize::MAX, known)
    }

    /// The same, given up soon after so many.
    fn below_to(&mut self, root: u32, most: usize, known: impl Fn(&Node) -> bool) -> Vec<u32> {
        self.looks = self.looks.wrapping_add(1);
        if self.looks == 0 {
            // The counter of walks has wrapped around: marks of old walks are erased, so that none is taken for a new
            // one.
            self.nodes.iter_mut().for_each(|node| node.seen = 0);
            self.looks = 1;
        }
        let looks = self.looks;
        let mut found = Vec::new();
        let mut waiting = vec![root];
        while let Some(i) = waiting.pop() {
            let node = &mut self.nodes[i as usize];
            if node.seen == looks {
                continue;
            }
            node.seen = looks;
            found.push(i);
            if found.len() > most {
                break;
            }
            if !known(node) {
                waiting.extend(operands(&node.op).into_iter().flatten());
            }
        }
        // Of a large expression that is asked about often, looking takes as long as computing.
        self.words += found.len() / 4;
        self.work += found.len() as u64 / 4;
        found.sort_unstable();
        found
    }

    /// How many nodes and how many roots there are below a node of which nothing exact is known.
    fn size(&mut self, x: Lazy) -> (usize, usize) {
        let tower = self.towers;
        let known = move |node: &Node| {
            let known = node.known.as_ref();
            known
                .and_then(|known| known.exact.as_ref())
                .is_some_and(|(of, value)| *of == tower || value.is_rational())
        };
        let order = self.below_to(x.0, SMALL, known);
        let roots = order.iter().filter(|&&i| {
            let node = &self.nodes[i as usize];
            matches!(node.op, Op::Sqrt(_)) && !known(node)
        });
        let roots = roots.count();
        (order.len(), roots)
    }

    /// The exact number, with so many roots in the tower and so many products of words at most. If it takes more, and
    /// there are roots that were adjoined for other numbers, then once again without those.
    fn exact(&mut self, x: Lazy, most: usize, work: usize) -> Result<Element, TooHard> {
        let others = self.tower.height() > 0;
        let most_now = most.max(self.tower.height().min(MOST_ROOTS));
        self.tower.begin(work);
        let mut result = self.try_exact(x.0, most_now);
        self.work += (work - self.tower.left()) as u64;
        if others && matches!(result, Err(TooHard::Roots | TooHard::Size)) {
            self.new_tower();
            self.tower.begin(work);
            result = self.try_exact(x.0, most);
            self.work += (work - self.tower.left()) as u64;
        }
        result
    }

    fn exactly(&self, i: u32) -> Option<&Element> {
        let (tower, value) = self.nodes[i as usize].known.as_ref()?.exact.as_ref()?;
        (*tower == self.towers || value.is_rational()).then_some(value)
    }

    fn try_exact(&mut self, root: u32, most: usize) -> Result<Element, TooHard> {
        let mut waiting = vec![root];
        while let Some(&i) = waiting.last() {
            if self.exactly(i).is_some() {
                waiting.pop();
                continue;
            }
            let op = &self.nodes[i as usize].op;
            let vanishes = match op {
                Op::Mul(a, b) => [a, b]
                    .into_iter()
                    .any(|&i| self.exactly(i).is_some_and(Element::is_zero)),
                _ => false,
            };
            let missing = operands(op)
                .into_iter()
                .flatten()
                .find(|&i| self.exactly(i).is_none());
            let value = match missing {
                _ if vanishes => Element::zero(),
                Some(i) => {
                    waiting.push(i);
                    continue;
                }
                None if self.exact_made > MOST_EXACT => return Err(TooHard::Size),
                None => {
                    self.exact_made += 1;
                    self.evaluate(i, most)?
                }
            };
            let known = self.nodes[i as usize].known.get_or_insert_default();
            known.exact = Some((self.towers, value));
            waiting.pop();
        }
        self.exactly(root).cloned().ok_or(TooHard::Undefined)
    }

    fn evaluate(&mut self, i: u32, most: usize) -> Result<Element, TooHard> {
        let of = |i: u32| self.exactly(i).ok_or(TooHard::Undefined);
        match &self.nodes[i as usize].op {
            Op::Number(value) => Ok(Element::Rational(ratio(*value))),
            Op::Ratio(value) => Ok(Element::Rational((**value).clone())),
            Op::Add(a, b) | Op::Sub(a, b) => {
                let (x, y) = (of(*a)?, of(*b)?);
                self.tower.spend_sum(x, y)?;
                if matches!(self.nodes[i as usize].op, Op::Add(..)) {
                    x.add(y)
                } else {
                    x.sub(y)
                }
            }
            Op::Mul(a, b) => self.tower.mul(of(*a)?, of(*b)?),
            Op::Div(a, b) => self.tower.div(of(*a)?, of(*b)?),
            Op::Neg(a) => Ok(of(*a)?.neg()),
            Op::Sqrt(a) => {
                let square = of(*a)?.clone();
                self.tower.sqrt(&square, most)
            }
            Op::Cosine(_) | Op::Versine(_) => Err(TooHard::Opaque),
            Op::Fault => Err(TooHard::Undefined),
        }
    }
}
