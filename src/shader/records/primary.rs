//! What primary rays ask, surfaces, and what a dispatch is told.

use crate::shader::record::{Pad1, Pad2, records};

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
        /// Records that the list of pixels in doubt has room for; 0 where there is no list.
        room: u32,
        /// Records that f64 is to take: no more than there is room for.
        taken: u32,
        /// Nothing.
        pad: Pad1,
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
