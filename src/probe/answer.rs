//! What an object answers to a ray, and in which words.

use std::fmt;

use super::digits;

/// What an object answers, exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HitOrMiss {
    /// It is hit.
    Hit,
    /// It is not.
    Miss(Reason),
}

/// Why an object is not hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reason {
    /// N·D = 0.
    Parallel,
    /// The plane contains the viewpoint: t = 0.
    ThroughViewpoint,
    /// t < 0.
    Behind,
    /// The plane is met at this z, above the screen tolerance.
    BeforeScreen(f64),
    /// The plane of a rectangle is met beside it.
    Outside {
        /// Along xdir (0), or along normal × xdir (1).
        side: usize,
        /// Where.
        at: f64,
        /// How long the side is.
        length: f64,
    },
    /// The plane of a triangle is met beside it, beyond the side between these vertices.
    BeyondEdge {
        /// Their numbers, from 1.
        vertices: [usize; 2],
    },
    /// A quadric is met where it is cut away.
    CutAway {
        /// The axis of the border.
        axis: usize,
        /// The coordinate there.
        at: f64,
    },
    /// The discriminant is negative.
    Passes,
    /// The discriminant is 0.
    Tangent,
    /// The viewpoint is in the sphere or on it.
    Inside,
}

impl Eq for Reason {}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parallel => f.write_str("the ray is parallel to it"),
            Self::ThroughViewpoint => f.write_str("the viewpoint lies on it"),
            Self::Behind => f.write_str("it is behind the viewpoint"),
            Self::BeforeScreen(z) => write!(f, "it is met in front of the screen, at z = {z}"),
            Self::Outside { side, at, length } => {
                let along = ["xdir", "normal × xdir"][*side];
                write!(
                    f,
                    "its plane is met outside the rectangle: at {} along {along}, where it reaches from 0 to {length}",
                    digits::short(*at)
                )
            }
            Self::BeyondEdge {
                vertices: [from, to],
            } => write!(
                f,
                "its plane is met outside the triangle: beyond the side from vertex{from} to vertex{to}"
            ),
            Self::CutAway { axis, at } => {
                let name = ["x", "y", "z"][*axis];
                write!(
                    f,
                    "it is met where it is cut away, at {name} = {}",
                    digits::short(*at)
                )
            }
            Self::Passes => f.write_str("the ray passes by"),
            Self::Tangent => f.write_str("the ray touches it, which is a miss"),
            Self::Inside => f.write_str("the viewpoint is inside it"),
        }
    }
}
