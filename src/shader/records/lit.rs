//! What scenes with lights ask besides: materials, lights, and objects that rays from anywhere may hit.

use crate::shader::record::{Pad1, Pad3, records};

records! {
    /// An object of a scene with lights.
    LitObject as "Object" {
        /// Index of the material.
        material: u32,
        /// As in [`Object`].
        kind: u32,
        /// Number of the surface that it is or is part of.
        group: u32,
        /// Index into the planes; into the spheres with the highest bit set, into the quadrics with the one below.
        place: u32,
    }

    /// A material of a scene with lights.
    Material as "Material" {
        /// Ambient reflectivity.
        #[factor = "colours and weights of rays are products of it"]
        ambient: [f32; 3],
        /// Share of light that goes through.
        #[factor = "colours and weights of rays are products of it"]
        transparency: f32,
        /// Diffuse reflectivity.
        #[factor = "colours and weights of rays are products of it"]
        diffuse: [f32; 3],
        /// Exponent of the glint, 0 for none.
        #[any_size = "a large one is compared with `MOST_SHININESS`, and left to the CPU"]
        shininess: f32,
        /// Specular reflectivity.
        #[factor = "colours and weights of rays are products of it"]
        specular: [f32; 3],
        /// Nothing.
        pad: Pad1,
        /// What tints light that goes through.
        #[factor = "colours and weights of rays are products of it"]
        tint: [f32; 3],
        /// 1 − transparency.
        #[factor = "colours and weights of rays are products of it"]
        kept: f32,
    }

    /// A light.
    Light as "Light" {
        /// From the viewpoint.
        location: [f32; 3],
        /// Cosine of the half angle; −2 for a light without a cone.
        cosine: f32,
        /// How bright it is.
        #[factor = "colours are products of it"]
        emissivity: [f32; 3],
        /// Length of `location`.
        size: f32,
        /// A spotlight's axis.
        axis: [f32; 3],
        /// Its place among the projectors, and 1; 0 for other lights.
        projector: u32,
    }

    /// The picture of a projector; v is the way from its location to a point. The point is beyond the picture's plane
    /// where normal·v > reach; the way crosses that plane at reach/(normal·v)·v, and texel column and row there are
    /// floor(row_i·that + start_i).
    Projector as "Projector" {
        /// Perpendicular to the picture, away from the location; of unit length.
        normal: [f32; 3],
        /// Distance of the location from the picture's plane.
        #[factor = "the share of a way up to the picture is a quotient of it"]
        reach: f32,
        /// Texels a unit along the first side, times its direction.
        row_0: [f32; 3],
        /// Column next to the location, with its fraction.
        start_0: f32,
        /// The same for the second side.
        row_1: [f32; 3],
        /// The same for the second side.
        start_1: f32,
        /// Texels along both sides.
        ends: [f32; 2],
        /// Columns and rows of the texture.
        size: [u32; 2],
        /// Lengths of the rows.
        row_lengths: [f32; 2],
        /// Bounds of the errors of column and row, but for what the way's error adds.
        errors: [f32; 2],
        /// The texture's first texel.
        first: u32,
        /// 1 where the picture repeats.
        repeats: u32,
        /// Number of the surface that the picture's plane is.
        group: u32,
        /// Nothing.
        pad: Pad1,
    }

    /// A plane, rectangle or triangle for rays from anywhere; positions are from the viewpoint.
    WorldPlane as "WorldPlane" {
        /// Unit normal.
        normal: [f32; 3],
        /// normal·P on the plane.
        offset: f32,
        /// Factors of a hit point: 0 for the plane's own coordinate, else 1.
        axis_mask: [f32; 3],
        /// Number of the surface.
        group: u32,
        /// The plane's own coordinate, else 0.
        fixed_coordinate: [f32; 3],
        /// Index of the object.
        object: u32,
        /// Direction of the first side; of a triangle, from its first side to the inside.
        row_0: [f32; 3],
        /// What is subtracted.
        origin_0: f32,
        /// Direction of the second side; of a triangle, from its second side to the inside.
        row_1: [f32; 3],
        /// What is subtracted.
        origin_1: f32,
        /// Lengths of the sides; of a triangle, more than any.
        #[any_size = "a number beyond all positions stands for no end, and it is only compared"]
        lengths: [f32; 2],
        /// Bit i: light i lies in the plane.
        lights_on_surface: u32,
        /// 1 for a rectangle; for a triangle 2 and the number of its third side.
        bounded: u32,
        /// A hit counts only up to this z.
        #[any_size = "the largest f32 stands for no limit, and it is only compared"]
        highest: f32,
        /// Bound of the errors of the coordinates on the rectangle, but for what the position's error adds.
        sides_error: f32,
        /// The bit of the light that is so near to the plane that its height is told, or 0.
        low_light: u32,
        /// That light's height above the plane, to the normal's side.
        height: f32,
    }

    /// A sphere for rays from anywhere; its center is from the viewpoint.
    WorldSphere as "WorldSphere" {
        /// From the viewpoint.
        center: [f32; 3],
        /// Its radius.
        #[factor = "its square must not vanish"]
        radius: f32,
        /// Number of the surface.
        group: u32,
        /// Index of the object.
        object: u32,
        /// Bit i: light i lies on the sphere.
        lights_on_surface: u32,
        /// Length of `center`.
        size: f32,
        /// 1 / radius.
        inverse_radius: f32,
        /// Nothing.
        pad: Pad3,
    }
}
