//! What attributes of an entity must keep between them.

use super::Relation;
use crate::scene::{number, triangle};

pub(super) const ALONG_NORMAL: &[Relation] = &[Relation {
    attribute: "xdir",
    others: &["normal"],
    broken: |d| {
        d.xdir
            .is_some_and(|xdir| number::parallel(&xdir, &d.normal))
    },
    message: "must not be parallel to `normal`: it is projected onto the plane",
}];

pub(super) const AIMLESS: &[Relation] = &[Relation {
    attribute: "point",
    others: &["location"],
    broken: |d| d.point == d.location,
    message: "must differ from `location`: the two give the direction of the light",
}];

pub(super) const FLAT: &[Relation] = &[
    Relation {
        attribute: "vertex3",
        others: &["vertex1", "vertex2"],
        broken: |d| triangle::in_line(&d.vertices),
        message: "must not lie in a line with `vertex1` and `vertex2`: they are no triangle",
    },
    Relation {
        attribute: "normal",
        others: &["vertex1", "vertex2", "vertex3"],
        broken: |d| {
            d.facing
                .is_some_and(|normal| triangle::is_in_plane(&normal, &d.vertices))
        },
        message: "must not lie in the plane of the triangle: it says which side is the front",
    },
];

pub(super) const EMPTY_BOX: &[Relation] = &[Relation {
    attribute: "upper",
    others: &["lower"],
    broken: |d| {
        let ends = d.lower.iter().flatten().zip(d.upper.iter().flatten());
        ends.into_iter().any(|(lower, upper)| lower >= upper)
    },
    message: "must be greater than `lower` in x, y and z: nothing would be left between them",
}];
