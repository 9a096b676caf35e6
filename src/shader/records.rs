//! The GPU's records, each a list of fields: see [`record`](super::record) for all that follows from it.

use super::record::{Pad1, Pad2, Pad3, records};

records! {
    /// An object of a scene without lights.
    Object as "Object" {
        /// Ambient reflectivity of the material.
        #[factor = "a colour is a product of it"]
        ambient: [f32; 3],
        /// Its kind of surface, `KIND_…`, in the low byte, the index of its record above.
        kind: u32,
    }

    /// A plane as primary rays see it, over the pixel (X, Y) from the anchor of the camera.
    Plane as "Plane" {
        /// 1/s over (X, Y, 1), the pixel from the camera's anchor.
        inverse: [f32; 3],
        /// Index of the object.
        object: u32,
        /// ≥ 0 over (X, Y, 1) where the hit counts.
        front: [f32; 3],
        /// Number of the surface, where others share it; else 0.
        group: u32,
        /// Bound of the error of 1/s.
        inverse_error: f32,
        /// Bound of the error of `front`.
        front_error: f32,
        /// Nothing.
        pad: Pad2,
    }

    /// A rectangle or a triangle as primary rays see it. A hit is inside where the forms of all four sides are ≥ 0,
    /// each up to a positive factor: of a rectangle p_i/s and (d_i − p_i)/s, where p are the coordinates on it and d
    /// its sides. The fourth of a triangle is 1.
    Polygon as "Polygon" {
        /// 1/s over (X, Y, 1).
        inverse: [f32; 3],
        /// Index of the object.
        object: u32,
        /// ≥ 0 over (X, Y, 1) where the hit counts.
        front: [f32; 3],
        /// As in a [`Plane`].
        group: u32,
        /// ≥ 0 over (X, Y, 1) on the inner side of the first side, and so on.
        side_0: [f32; 3],
        /// Bound of the error of 1/s.
        inverse_error: f32,
        /// The side next to it.
        side_1: [f32; 3],
        /// Bound of the error of `front`.
        front_error: f32,
        /// The side opposite the first.
        side_2: [f32; 3],
        /// 1/s is no larger; where triangles are many.
        #[any_size = "it is only compared"]
        max_inverse: f32,
        /// The side opposite the second.
        side_3: [f32; 3],
        /// Nothing.
        pad_1: Pad1,
        /// Bounds of the errors of the four sides.
        side_errors: [f32; 4],
    }

    /// A sphere as primary rays see it, over the pixel (X, Y) from its anchor: 1/s = gain·(along + √disc) for the
    /// nearer hit, along linear and disc quadratic. Where the outline is an ellipse the anchor is a pixel next to its
    /// middle.
    Sphere as "Sphere" {
        /// e·W over (X, Y, 1), the pixel from `anchor`.
        along: [f32; 3],
        /// |C|/(|C|² − r²).
        gain: f32,
        /// The discriminant's coefficients of X², XY, Y².
        square: [f32; 3],
        /// Index of the object.
        object: u32,
        /// The discriminant's coefficients of X, Y, 1.
        affine: [f32; 3],
        /// Bound of the error of `along`.
        along_error: f32,
        /// Where X and Y start.
        anchor: [i32; 2],
        /// Bound of the error of the discriminant.
        disc_error: f32,
        /// 1/s is no larger; where spheres are many.
        #[any_size = "it is only compared"]
        max_inverse: f32,
    }

    /// Where a sphere that a primary ray meets is met: (H − C)/(r·s) = forms·(X, Y, 1) − center·√disc.
    SphereHit as "SphereHit" {
        /// First component over (X, Y, 1).
        form_x: [f32; 3],
        /// Bound of the errors of the forms, as a vector.
        form_error: f32,
        /// Second component.
        form_y: [f32; 3],
        /// gain·|C|/r.
        center_size: f32,
        /// Third component.
        form_z: [f32; 3],
        /// Nothing.
        pad_0: Pad1,
        /// gain·C/r.
        center: [f32; 3],
        /// Nothing.
        pad_1: Pad1,
    }

    /// A sphere with what is needed where its hits are looked at: in one buffer, as some drivers allow only ten.
    SphereAndHit as "SphereAndHit" {
        /// The sphere.
        sphere: Sphere,
        /// Where it is hit.
        hit: SphereHit,
    }

    /// A box of the tree over many spheres.
    BvhNode as "BvhNode" {
        /// Least corner of the box.
        min: [f32; 3],
        /// First sphere of a leaf, or first child.
        first: u32,
        /// Greatest corner of the box.
        max: [f32; 3],
        /// Spheres of a leaf; 0 for an inner node.
        count: u32,
    }

    /// The tiles of a `tiled_plane`: their indices along both directions are floor(row_i·P + fraction_i), up to
    /// `parity`.
    TiledPlane as "Tiled" {
        /// Tiles a unit along the first direction, times the direction.
        row_0: [f32; 3],
        /// Fraction of the index at the viewpoint.
        fraction_0: f32,
        /// The same for the second direction.
        row_1: [f32; 3],
        /// The same for the second direction.
        fraction_1: f32,
        /// Ambient reflectivity of the other material.
        #[factor = "a colour is a product of it"]
        altmaterial: [f32; 3],
        /// Index of the other material.
        altindex: u32,
        /// The parities together: odd sums have the other material.
        parity: f32,
        /// Nothing.
        pad_0: Pad1,
        /// Lengths of the rows.
        row_lengths: [f32; 2],
        /// Bounds of the indices' errors, but for what the position's error adds.
        errors: [f32; 2],
        /// Nothing.
        pad_1: Pad2,
    }

    /// What a `pplane` shader is told: the indices floor(2·H + 1000) are floor(P·per_unit + fraction), up to `parity`.
    ProceduralPlane as "Pplane" {
        /// Tiles a unit, along x, y, z.
        per_unit: [f32; 3],
        /// Bound of the indices' errors, but for what the position's error adds.
        index_error: f32,
        /// Fraction of the index at the viewpoint.
        fraction: [f32; 3],
        /// The same for `from_point`.
        from_point_error: f32,
        /// Parities, 0 or 1.
        parity: [f32; 3],
        /// Nothing.
        pad: Pad1,
        /// Factors of x and y, then what is subtracted from them.
        from_point: [f32; 4],
    }

    /// The rectangle of pixels that one dispatch makes.
    Dispatch as "Dispatch" {
        /// Column and row (from the bottom) of the top left pixel.
        first: [u32; 2],
        /// Columns and rows.
        size: [u32; 2],
        /// 0, which only the host knows.
        zero: u32,
        /// Records that the list of pixels with doubtful samples has room for; 0 where there is no list.
        room: u32,
    }

    /// The camera. Its numbers stand in the text of the shader, or behind `Dispatch` while it moves.
    CameraNumbers as "CameraNumbers" {
        /// Pixel next to the viewpoint.
        anchor: [i32; 2],
        /// From one pixel to the next.
        step: [f32; 2],
        /// W.x and W.y at the anchor.
        offset: [f32; 2],
        /// −W.z.
        distance: f32,
        /// 255 / 2^scale.
        gain: f32,
        /// 1 / 2^scale.
        unit: f32,
        /// Nothing.
        pad: Pad1,
    }

    /// The picture on a `texplane`: texel column and row are floor(row_i·P − origin_i).
    Texplane as "Texplane" {
        /// Texels a unit along the first side, times its direction.
        row_0: [f32; 3],
        /// What is subtracted.
        origin_0: f32,
        /// The same for the second side.
        row_1: [f32; 3],
        /// The same for the second side.
        origin_1: f32,
        /// Columns and rows of the texture.
        size: [u32; 2],
        /// Its first texel.
        first: u32,
        /// 1 where the picture repeats.
        repeats: u32,
        /// Lengths of the rows.
        row_lengths: [f32; 2],
        /// Bounds of the indices' errors, but for what the position's error adds.
        errors: [f32; 2],
    }

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

    /// A quadric; positions are from the viewpoint. About its `center` C, which is a point near it, the left side of
    /// its equation is p·Ap + 2·slope·p + constant, p = H − C.
    Quadric as "Quadric" {
        /// From the viewpoint, exactly.
        center: [f32; 3],
        /// Index of the object.
        object: u32,
        /// Diagonal of A.
        diagonal: [f32; 3],
        /// Number of the surface.
        group: u32,
        /// What stands beside it: yz, xz, xy.
        beside: [f32; 3],
        /// The left side at C.
        constant: f32,
        /// Diagonal of the adjoint of A.
        adjoint_diagonal: [f32; 3],
        /// A vector becomes by A at most so many times as long.
        norm: f32,
        /// What stands beside it.
        adjoint_beside: [f32; 3],
        /// The same for the adjoint.
        adjoint_norm: f32,
        /// Half the gradient at C.
        slope: [f32; 3],
        /// Its length.
        slope_size: f32,
        /// The least coordinates of hits.
        #[any_size = "a number beyond all positions stands for no border, and it is only compared"]
        lower: [f32; 3],
        /// Length of `center`.
        size: f32,
        /// The greatest coordinates of hits; that of z is the front rule's at most.
        #[any_size = "a number beyond all positions stands for no border, and it is only compared"]
        upper: [f32; 3],
        /// Bit i: light i lies on the surface.
        lights_on_surface: u32,
    }
}

/// What the shader is told of the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackedCamera {
    /// Its numbers, which go into the text of the shader as a rule.
    pub numbers: CameraNumbers,
    /// Bound of the error of W, as a vector.
    pub w_error: f32,
    /// κ ≥ 1 (docs/NUMERICS.md): the terms that W·W is a sum of, over W·W.
    pub condition: f32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::bounds::{LARGEST, SMALLEST};
    use crate::shader::record::{FieldLayout, Layout};

    /// How many f32 stand in a field, those of a record within it not counted: that is tested by itself.
    fn floats(field: &FieldLayout) -> usize {
        match field.wgsl {
            "f32" => 1,
            "vec2f" => 2,
            "vec3f" => 3,
            "vec4f" => 4,
            _ => 0,
        }
    }

    /// Whether the record fits that is 0 but for one number.
    fn fits_with(layout: &Layout, offset: usize, value: f32) -> bool {
        let mut bytes = vec![0; layout.size];
        bytes[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
        (layout.fits)(&bytes)
    }

    /// A factor that f32 might flush is noticed, and nothing else need not be tiny.
    #[test]
    fn a_tiny_factor_is_noticed() {
        let smallest = SMALLEST as f32;
        let mut factors = 0;
        for layout in LAYOUTS {
            for field in layout.fields {
                for offset in (0..floats(field)).map(|i| field.offset + 4 * i) {
                    assert!(fits_with(layout, offset, smallest));
                    for value in [smallest.next_down(), f32::MIN_POSITIVE, 1e-45] {
                        let fits = fits_with(layout, offset, value);
                        assert_eq!(
                            fits,
                            field.factor.is_none(),
                            "{}.{}",
                            layout.name,
                            field.name
                        );
                    }
                    factors += usize::from(field.factor.is_some());
                }
            }
        }
        assert!(factors > 20, "{factors}");
    }

    /// What a field holds is checked unless the field says why it need not be: none can be forgotten.
    #[test]
    fn a_large_number_in_any_field_is_noticed() {
        let largest = LARGEST as f32;
        let (mut checked, mut free) = (0, 0);
        for layout in LAYOUTS {
            for field in layout.fields {
                for offset in (0..floats(field)).map(|i| field.offset + 4 * i) {
                    assert!(fits_with(layout, offset, largest));
                    for value in [largest.next_up(), -f32::MAX, f32::INFINITY, f32::NAN] {
                        let fits = fits_with(layout, offset, value);
                        assert_eq!(
                            fits,
                            field.any_size.is_some(),
                            "{}.{}",
                            layout.name,
                            field.name
                        );
                    }
                    checked += 1;
                    free += usize::from(field.any_size.is_some());
                }
            }
        }
        assert!(checked > 150 && free < 20, "{checked} {free}");
    }
}
