//! What a surface reflects at a hit (docs/SCENE.md, "What a surface reflects").

use dashu_int::IBig;
use plumb::scene::{Shape, Surface, TextureMode};

use super::real::{Real, Unresolved};
use super::vector::Vector;
use super::world::{Body, Form, Sides, Stuff, World};

/// Whether a whole number is odd.
fn odd(n: &IBig) -> bool {
    n % 2 != 0
}

/// floor(2·c + 1000), the index of the procedural tiles.
fn half_tile(c: &Real) -> Result<IBig, Unresolved> {
    (&(&Real::integer(2) * c) + &Real::integer(1000)).floor()
}

/// (1 + cos φ, 1 + cos(φ + 2π/3), 1 + cos(φ + 4π/3)) of the doubled angle φ of (x, y) from +x; of 0 for no angle.
fn wheel(x: &Real, y: &Real) -> Result<Vector, Unresolved> {
    let square = &x.square() + &y.square();
    let (cosine, sine) = if square.is_zero()? {
        (Real::integer(1), Real::integer(0))
    } else {
        (
            &(&x.square() - &y.square()) / &square,
            &(&Real::integer(2) * &(x * y)) / &square,
        )
    };
    let one = Real::integer(1);
    let middle = &one - &(&cosine / &Real::integer(2));
    let swing = &(&Real::integer(3).sqrt() / &Real::integer(2)) * &sine;
    Ok(Vector([&one + &cosine, &middle - &swing, &middle + &swing]))
}

impl World<'_> {
    pub(crate) fn stuff(&self, body: &Body<'_>) -> &Stuff {
        &self.materials[body.object.material]
    }

    /// The material of the tile, elsewhere the object's.
    pub(crate) fn tile(&self, body: &Body<'_>, hit: &Vector) -> Result<&Stuff, Unresolved> {
        let Surface::Tiled {
            dimension,
            altmaterial,
            ..
        } = body.object.surface
        else {
            return Ok(self.stuff(body));
        };
        let far = Real::integer(10_000);
        let own = if let Some(sides) = &body.sides {
            let mut sum = IBig::ZERO;
            for i in [0, 1] {
                let place = &sides.directions[i].dot(hit) / &sides.lengths[i];
                sum += (&(&place + &far) / &sides.dimensions[i]).floor()?;
            }
            odd(&sum)
        } else {
            let mut sum = IBig::ZERO;
            for (c, size) in [(&hit.0[0], dimension.x), (&hit.0[2], dimension.y)] {
                sum += (&(c + &far) / &Real::from_f64(size)).floor()?;
            }
            !odd(&sum)
        };
        Ok(if own {
            self.stuff(body)
        } else {
            &self.materials[altmaterial]
        })
    }

    pub(crate) fn ambient(&self, body: &Body<'_>, hit: &Vector) -> Result<Vector, Unresolved> {
        let own = &self.stuff(body).ambient;
        let Surface::Procedural { shader } = body.object.surface else {
            let ambient = &self.tile(body, hit)?.ambient;
            return self.textured(body, hit, ambient);
        };
        let from = match (&body.object.shape, &body.form) {
            (Shape::Quadric(_), _) | (_, Form::Quadric(_)) => hit.clone(),
            (_, Form::Plane { point, .. }) => hit - point,
            (_, Form::Sphere { center, .. }) => hit - center,
        };
        let [x, y, _] = &from.0;
        if let Form::Sphere { .. } = body.form {
            let y = if y.is_positive()? { -y } else { y.clone() };
            return wheel(x, &y);
        }
        let six = Real::integer(6);
        let columns = |which: &[usize]| -> Result<bool, Unresolved> {
            let mut sum = IBig::ZERO;
            for i in which {
                sum += half_tile(&hit.0[*i])?;
            }
            Ok(odd(&sum))
        };
        Ok(match shader {
            0 => {
                let mut colour = own.clone();
                colour.0[if columns(&[0, 2])? { 0 } else { 2 }] = Real::integer(0);
                colour
            }
            1 => wheel(x, y)?.scale(&six),
            2 if columns(&[0, 1, 2])? => own.clone(),
            2 => wheel(x, y)?.scale(&six),
            _ => panic!("shader {shader}"),
        })
    }

    pub(crate) fn diffuse(&self, body: &Body<'_>, hit: &Vector) -> Result<Vector, Unresolved> {
        let diffuse = &self.tile(body, hit)?.diffuse;
        self.textured(body, hit, diffuse)
    }

    /// A reflectivity times the texel at the hit, if there is a texture.
    fn textured(
        &self,
        body: &Body<'_>,
        hit: &Vector,
        colour: &Vector,
    ) -> Result<Vector, Unresolved> {
        let (Surface::Textured { texture, mode }, Some(sides), Form::Plane { point: corner, .. }) =
            (body.object.surface, &body.sides, &body.form)
        else {
            return Ok(colour.clone());
        };
        Ok(colour.times(&self.texel((texture, mode), sides, corner, hit)?))
    }

    /// The texel at a point of a rectangle.
    pub(crate) fn texel(
        &self,
        (texture, mode): (usize, TextureMode),
        sides: &Sides,
        corner: &Vector,
        hit: &Vector,
    ) -> Result<Vector, Unresolved> {
        let texels = &self.scene.textures[texture].texels;
        let camera = &self.scene.camera;
        let from_corner = hit - corner;
        let mut index = [0_u32; 2];
        for i in [0, 1] {
            let count = [texels.width, texels.height][i];
            let place = &sides.directions[i].dot(&from_corner) / &sides.lengths[i];
            let whole = match mode {
                TextureMode::Fit => {
                    let part = &place / &sides.dimensions[i];
                    (&part * &Real::integer(i64::from(count)))
                        .floor()?
                        .clamp(IBig::ZERO, IBig::from(count - 1))
                }
                TextureMode::Tile => {
                    let pixel = &Real::from_f64(camera.worlddim[i])
                        / &Real::integer(i64::from(camera.pixeldim[i]));
                    let n = (&place / &pixel).floor()? % IBig::from(count);
                    // Places in the rectangle are not negative.
                    n
                }
            };
            index[i] = u32::try_from(whole).expect("below the texture's size");
        }
        let row = texels.height - 1 - index[1];
        let at = 3 * (row as usize * texels.width as usize + index[0] as usize);
        let texel = [0, 1, 2].map(|c| {
            let byte = Real::integer(i64::from(texels.rgb[at + c]));
            &byte / &Real::integer(256)
        });
        Ok(Vector(texel))
    }
}
