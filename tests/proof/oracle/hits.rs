//! Where a line meets the objects (docs/SCENE.md, "Hits"), nearest first: all that closest hits, shadows and rays
//! straight through ask for.
//!
//! A ray that goes on through a surface stays on its line: its hits are those of the line beyond the surface, but of
//! the object that it left last. Parameters, not distances: the direction has any length.

use std::cmp::Ordering;

use plumb::scene::{Extent, Shape, Triangle};

use super::Fault;
use super::real::{Real, Unresolved};
use super::vector::Vector;
use super::world::{Body, Form, Quadric, Sides, World};

/// Where a line meets an object.
#[derive(Debug)]
pub(crate) struct Hit {
    /// base + along · direction is the point.
    pub(crate) along: Real,
    /// Index of the object.
    pub(crate) object: usize,
    pub(crate) point: Vector,
    /// Other objects that are met there too, all later in the file.
    pub(crate) behind: Vec<usize>,
}

impl Hit {
    /// The object that a ray meets here which left `last`, if any: the first in the file.
    pub(crate) fn met(&self, last: Option<usize>) -> Option<usize> {
        let mut objects = [self.object].into_iter().chain(self.behind.iter().copied());
        objects.find(|object| Some(*object) != last)
    }
}

impl World<'_> {
    /// The hits of a line that left from the object `last`. With `end`, which is base + direction, only those before
    /// it.
    pub(crate) fn hits(
        &self,
        base: &Vector,
        direction: &Vector,
        last: Option<usize>,
        end: Option<&Vector>,
    ) -> Result<Vec<Hit>, Unresolved> {
        let mut hits: Vec<Hit> = Vec::new();
        let mut crossings: Vec<Option<Vec<(Real, Vector)>>> = vec![None; self.carriers];
        let left = last.map(|last| self.bodies[last].carrier);
        for (object, body) in self.bodies.iter().enumerate() {
            if crossings[body.carrier].is_none() {
                let leaves = left == Some(body.carrier);
                let met = match &body.form {
                    Form::Quadric(quadric) => {
                        self.crossings(quadric, base, direction, end, leaves)?
                    }
                    // Whatever lies on the plane or sphere that the line leaves from is met at its base, where t = 0: a
                    // miss.
                    Form::Plane { .. } | Form::Sphere { .. } if leaves => Vec::new(),
                    Form::Plane { .. } | Form::Sphere { .. } => {
                        let crossing = self.crossing(body, base, direction, end)?;
                        crossing.into_iter().collect()
                    }
                };
                crossings[body.carrier] = Some(met);
            }
            for (along, point) in crossings[body.carrier].iter().flatten() {
                if self.within(body, point)? {
                    self.insert(&mut hits, along, object, point)?;
                }
            }
        }
        Ok(hits)
    }

    /// Puts a hit in its place. Objects come in file order, so a new one goes after its equals.
    fn insert(
        &self,
        hits: &mut Vec<Hit>,
        along: &Real,
        object: usize,
        point: &Vector,
    ) -> Result<(), Unresolved> {
        let (mut low, mut high) = (0, hits.len());
        while low < high {
            let middle = (low + high) / 2;
            match along.compare(&hits[middle].along)? {
                Ordering::Less => high = middle,
                Ordering::Greater => low = middle + 1,
                Ordering::Equal => {
                    let equal = &mut hits[middle];
                    if self.rules.fault == Some(Fault::LaterOfEquals) {
                        equal.behind.insert(0, equal.object);
                        equal.object = object;
                    } else {
                        equal.behind.push(object);
                    }
                    return Ok(());
                }
            }
        }
        let hit = Hit {
            along: along.clone(),
            object,
            point: point.clone(),
            behind: Vec::new(),
        };
        hits.insert(low, hit);
        Ok(())
    }

    /// Where a line meets a quadric, borders aside; `leaves` if its base is on it.
    fn crossings(
        &self,
        quadric: &Quadric,
        base: &Vector,
        direction: &Vector,
        end: Option<&Vector>,
        leaves: bool,
    ) -> Result<Vec<(Real, Vector)>, Unresolved> {
        // f(t) = a t² + b t + c, with f(0) = c at the base and f(1) at the end.
        let a = direction.dot(&quadric.turned(direction));
        let b = quadric.gradient(base).dot(direction);
        let c = quadric.left_side(base);
        let ends_on_it = match end {
            Some(end) => quadric.left_side(end).is_zero()?,
            None => false,
        };
        let roots = match (leaves, ends_on_it) {
            // What is left are roots at the base and at the lamp, neither of which counts.
            (true, true) => Vec::new(),
            // Of two roots that one is known of, the other is −b/a − 0 or c/a over 1.
            (true, false) if a.is_zero()? => Vec::new(),
            (true, false) => vec![&-&b / &a],
            (false, true) if a.is_zero()? => Vec::new(),
            (false, true) => vec![&c / &a],
            (false, false) if a.is_zero()? => {
                if b.is_zero()? {
                    Vec::new()
                } else {
                    vec![&-&c / &b]
                }
            }
            (false, false) => {
                let four = Real::integer(4);
                let discriminant = &b.square() - &(&four * &(&a * &c));
                let twice = &a + &a;
                match discriminant.sign()? {
                    Ordering::Greater => {
                        let root = discriminant.sqrt();
                        let sum = &-&b + &root;
                        vec![&(&-&b - &root) / &twice, &sum / &twice]
                    }
                    Ordering::Equal if self.rules.fault == Some(Fault::TangentHits) => {
                        vec![&-&b / &twice]
                    }
                    Ordering::Equal | Ordering::Less => Vec::new(),
                }
            }
        };
        let mut met = Vec::new();
        for along in roots {
            let before = end.is_none() || along.compare(&Real::integer(1))? == Ordering::Less;
            if !before || !along.is_positive()? {
                continue;
            }
            let hit = base + &direction.scale(&along);
            if hit.0[2].compare(&self.tolerance)? != Ordering::Greater {
                met.push((along, hit));
            }
        }
        Ok(met)
    }

    /// Where a line meets the plane or sphere that an object lies on, as parameter and point.
    fn crossing(
        &self,
        body: &Body<'_>,
        base: &Vector,
        direction: &Vector,
        end: Option<&Vector>,
    ) -> Result<Option<(Real, Vector)>, Unresolved> {
        match &body.form {
            Form::Quadric(_) => panic!("a quadric may be met twice"),
            Form::Plane {
                normal,
                point,
                axis,
                ..
            } => {
                // t = over/under > 0 just if both have the same sign.
                let under = normal.dot(direction);
                let side = under.sign()?;
                if side == Ordering::Equal {
                    return Ok(None);
                }
                let over = normal.dot(&(point - base));
                if over.sign()? != side {
                    return Ok(None);
                }
                // 1 − over/under = N·(end − Q)/under.
                if let Some(end) = end
                    && normal.dot(&(end - point)).sign()? != side
                {
                    return Ok(None);
                }
                let along = &over / &under;
                let mut hit = base + &direction.scale(&along);
                if let Some(axis) = *axis {
                    hit.0[axis] = point.0[axis].clone();
                }
                if hit.0[2].compare(&self.tolerance)? == Ordering::Greater {
                    return Ok(None);
                }
                Ok(Some((along, hit)))
            }
            Form::Sphere { center, square } => {
                // f(t) = a t² − 2b t + c = 0 has two roots, the nearer one > 0, just if b, c and b² − ac are.
                let to_center = center - base;
                let b = direction.dot(&to_center);
                if !b.is_positive()? {
                    return Ok(None);
                }
                let c = &to_center.dot(&to_center) - square;
                if !c.is_positive()? {
                    return Ok(None);
                }
                let a = direction.dot(direction);
                let mut sure = false;
                if let Some(end) = end {
                    // From f(0) = c > 0 to f(1), which needs no base.
                    let from_center = end - center;
                    let last = (&from_center.dot(&from_center) - square).sign()?;
                    // Below 0 there is one root between. At 0, 1 is a root, and the nearer one just if the middle of
                    // both, b/a, is not below 1; then the ray ends where it meets the sphere. Above 0 both are on one
                    // side of 1.
                    let both = || from_center.dot(direction).is_positive();
                    let blocks_at_lamp =
                        last == Ordering::Equal && self.rules.fault == Some(Fault::BlocksAtLamp);
                    if last != Ordering::Less && !blocks_at_lamp && !both()? {
                        return Ok(None);
                    }
                    sure = last != Ordering::Greater;
                }
                let discriminant = &b.square() - &(&a * &c);
                if !sure {
                    let tangent_hits = self.rules.fault == Some(Fault::TangentHits);
                    match discriminant.sign()? {
                        Ordering::Greater => {}
                        Ordering::Equal if tangent_hits => {}
                        _ => return Ok(None),
                    }
                }
                // (b − √(b² − ac))/a, without the difference.
                let along = &c / &(&b + &discriminant.sqrt());
                let hit = base + &direction.scale(&along);
                Ok(Some((along, hit)))
            }
        }
    }

    /// Whether a point of the surface that an object lies on is the object's: a rectangle ends, and a quadric may be
    /// cut.
    fn within(&self, body: &Body<'_>, hit: &Vector) -> Result<bool, Unresolved> {
        for (axis, least, border) in &body.borders {
            let beyond = if *least {
                Ordering::Less
            } else {
                Ordering::Greater
            };
            if hit.0[*axis].compare(border)? == beyond {
                return Ok(false);
            }
        }
        match body.object.shape {
            Shape::Plane {
                extent: Extent::Rectangle(_),
                ..
            } => {}
            Shape::Triangle(triangle) => return self.within_triangle(&triangle, hit),
            Shape::Plane {
                extent: Extent::Unbounded,
                ..
            }
            | Shape::Sphere { .. }
            | Shape::Quadric(_) => return Ok(true),
        }
        let (Form::Plane { point: corner, .. }, Some(sides)) = (&body.form, &body.sides) else {
            panic!("a rectangle is a plane with sides");
        };
        self.within_sides(sides, corner, hit)
    }

    /// Whether a point of the plane of a rectangle is the rectangle's.
    pub(crate) fn within_sides(
        &self,
        sides: &Sides,
        corner: &Vector,
        hit: &Vector,
    ) -> Result<bool, Unresolved> {
        let from_corner = hit - corner;
        for i in [0, 1] {
            let place = sides.directions[i].dot(&from_corner);
            let end = &sides.dimensions[i] * &sides.lengths[i];
            let (low, high) = (place.sign()?, place.compare(&end)?);
            let edge = low == Ordering::Equal || high == Ordering::Equal;
            let open = self.rules.fault == Some(Fault::OpenRectangle);
            if low == Ordering::Less || high == Ordering::Greater || edge && open {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether a point of the plane of three vertices lies between them: with each two of them, in their order, it
    /// makes a triangle that is turned as they are.
    fn within_triangle(&self, triangle: &Triangle, hit: &Vector) -> Result<bool, Unresolved> {
        let corners = triangle.vertices.map(Vector::from_f64);
        let turn = |a: &Vector, b: &Vector, c: &Vector| (b - a).cross(&(c - a));
        let whole = turn(&corners[0], &corners[1], &corners[2]);
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let part = turn(&corners[i], &corners[j], hit).dot(&whole).sign()?;
            let open = self.rules.fault == Some(Fault::OpenRectangle);
            if part == Ordering::Less || part == Ordering::Equal && open {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
