//! A projector's rectangle as the light from its location meets it. Stands below `material`, beside `surface`.

use super::camera;
use super::extent::{Rectangle, shortened};
use super::surface::Textured;
use crate::real::rational::{
    Ratio, abs, dot, is_positive, is_zero, power_of_two, ratio, ratio3, sub,
};
use crate::real::{Real, V3};
use crate::scene::{ProjectorPicture, Scene};

/// The rectangle that a projector's light passes through, and the picture on it.
#[derive(Debug, Clone)]
pub struct Projector<R> {
    /// Perpendicular to the rectangle, away from the location; its largest component is 1 or −1. Rational.
    pub direction: V3<R>,
    /// direction · P for the points P of the rectangle's plane.
    pub constant: R,
    /// direction · (P − location) for the same points, > 0; None if the location lies in that plane: then no segment
    /// from there crosses it, and nothing is lit.
    pub reach: Option<R>,
    /// The rectangle with its picture.
    pub picture: Textured<R>,
}

impl<R: Real> Projector<R> {
    /// Prepares what a projector at `location` throws.
    pub(super) fn new(scene: &Scene, location: glam::DVec3, picture: &ProjectorPicture) -> Self {
        let ProjectorPicture {
            normal,
            point,
            rectangle,
            texture,
            mode,
        } = *picture;
        let scale = camera::exponent(scene.camera.viewpoint.z);
        let unit = power_of_two(scale);
        let (n, q) = (ratio3(normal), ratio3(point));
        let largest = ratio(normal.abs().max_element());
        let along = |v: &[Ratio; 3]| dot(&n, v) / &largest / &unit;
        let reach = along(&sub(&q, &ratio3(location)));
        let turned = R::exact(if is_positive(&reach) { 1.0 } else { -1.0 });
        let constant = R::ratio(&along(&sub(&q, &ratio3(scene.camera.viewpoint))));
        let rectangle = Rectangle::new(&scene.camera, scale, normal, point, &rectangle);
        Self {
            direction: shortened::<R>(normal) * turned,
            constant: constant * turned,
            reach: (!is_zero(&reach)).then(|| R::ratio(&abs(reach))),
            picture: Textured::new(scene, rectangle, texture, mode),
        }
    }
}
