// What a light brings to a hit point. Referee: src/cpu/light.rs.

//#insert struct Light

// The transmittance: what of a light reaches the point.
struct Shadow {
    transmittance: vec3f,
    // Whether nothing that is opaque stands between; of what panes let through nothing need be left.
    open: bool,
//#if certified
    sure: bool,
    // Roundings of the transmittance.
    roundings: f32,
//#end
}

// The transmittance from the point to light number `number`; `range` ends at the light.
fn shadow(ray: SecondaryRay, range_: Range) -> Shadow {
//#if transparent
    var range = range_;
    var transmittance = vec3f(1.0);
    var roundings = 0.0; //~
    loop {
        let hit = closest_hit(ray, range, LANES);
        steps += 2u * LANES;
//#if certified
        let left = range.limit - hit.t;
        let left_error = hit.error + range.limit_error;
        if (hit.rival - range.limit > range.limit_error) & ((hit.object == NOTHING) | (left < -left_error)) {
            return Shadow(transmittance, true, true, roundings);
        }
        if (hit.object == NOTHING) | !surely_closest(hit) | !(left > left_error) | (steps > STEPS_LIMIT) {
            return Shadow(vec3f(1.0), true, false, 0.0);
        }
//#else
        if (hit.object == NOTHING) | (steps > STEPS_LIMIT) {
            return Shadow(transmittance, true);
        }
//#end
        let blocker = locate_secondary(ray, hit);
        let material = materials[objects[hit.object].material];
        if material.transparency == 0.0 {
//#if certified
            return Shadow(vec3f(0.0), false, true, 0.0);
//#else
            return Shadow(vec3f(0.0), false);
//#end
        }
        // The product is kept above 0, so that it is never flushed: the glint shines through however little else does.
        transmittance = max(transmittance * (materials[tile_material(blocker)].tint * material.transparency),
            vec3f(0x1p-120f));
        roundings += PANE_ROUNDINGS; //~
        range.skip = blocker.group;
        range.beyond = hit.t;
        range.beyond_error = hit.error; //~
    }
//#if certified
    return Shadow(transmittance, true, false, 0.0);
//#else
    return Shadow(transmittance, true);
//#end
//#else
    let found = any_hit(ray, range_);
//#if certified
    return Shadow(vec3f(1.0), found != 2u, found != 1u, 0.0);
//#else
    return Shadow(vec3f(1.0), found != 2u);
//#end
//#end
}
//#if glint

// x to the power of n, a whole number below 1024.
fn power(x: f32, n: u32) -> f32 {
    var result = select(1.0, x, (n & 1u) != 0u);
    var square = x * x;
    result *= select(1.0, square, (n & 2u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 4u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 8u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 16u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 32u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 64u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 128u) != 0u);
    square *= square;
    result *= select(1.0, square, (n & 256u) != 0u);
    square *= square;
    return result * select(1.0, square, (n & 512u) != 0u);
}
//#end

// What light number `number` brings to a point with diffuse reflectivity `diffuse`, seen by a ray.
fn light_term(number: u32, point: Point, seen: SecondaryRay, diffuse: vec3f) -> Shade {
    var shade: Shade;
    let light = lights[number];
    let bit = select(0u, 1u << number, number < 32u);
//#if lights_on_surface
    if (point.lights_on_surface & bit) != 0u {
        return shade;
    }
//#end
    let toward = barrier(light.location - point.position);
    let toward_2 = dot(toward, toward);
    let inverse = inverseSqrt(max(toward_2, TINY_SQUARE));
    let distance = toward_2 * inverse;
    let d = toward * inverse;
    let c = dot(d, point.normal);
//#if certified
    let toward_error = point.error + U * (light.size + TOWARD_ROUNDINGS * distance);
    if !(distance > CLOSE_FROM * toward_error) {
        doubt = true;
        return shade;
    }
    let d_error = CLOSE * toward_error * inverse + DIRECTION_ROUNDINGS * U;
    let distance_error = toward_error + LIMIT_ROUNDINGS * U * distance;
    let c_error = d_error + point.normal_error + DOT_ROUNDINGS * U;
    if c < -c_error {
        return shade;
    }
    var sure = c > c_error;
//#else
    if !((toward_2 > 0.0) & (c > 0.0)) {
        return shade;
    }
//#end
//#if cone
    let inside = -dot(d, light.axis) - light.cosine;
//#if certified
    let inside_error = d_error + CONE_ROUNDINGS * U;
    if light.cosine >= -1.0 {
        if inside < -inside_error {
            return shade;
        }
        sure &= inside > inside_error;
    }
//#else
    if !(inside > 0.0) {
        return shade;
    }
//#end
//#end
//#if certified
    let way = SecondaryRay(point.position, d, point.error, d_error, point.size);
    let blocked = shadow(way, Range(point.group, bit, 0.0, distance, 0.0, distance_error));
    sure &= blocked.sure;
//#else
    let blocked = shadow(SecondaryRay(point.position, d), Range(point.group, bit, 0.0, distance));
//#end
    if !blocked.open {
        return shade;
    }
    let full = diffuse * light.emissivity * blocked.transmittance * (inverse * CAMERA_UNIT);
    shade.color = full * max(c, 0.0);
    shade.error = full //~
        * (c_error + max(c, 0.0) * (CLOSE * distance_error * inverse + (LIGHT_ROUNDINGS + blocked.roundings) * U)); //~
//#if glint
    let material = materials[objects[point.object].material];
    if material.shininess > 0.0 {
        let back = barrier(seen.base - point.position);
        let back_2 = dot(back, back);
        let back_inverse = inverseSqrt(max(back_2, TINY_SQUARE));
        let half = barrier(back * back_inverse + d);
        let half_2 = dot(half, half);
        let half_inverse = inverseSqrt(max(half_2, TINY_SQUARE));
        let cosine = dot(half, point.normal) * half_inverse;
//#if certified
        let back_error = seen.base_error + point.error + TOWARD_ROUNDINGS * U * back_2 * back_inverse;
        let half_error = CLOSE * back_error * back_inverse + d_error + HALF_ROUNDINGS * U;
        let cosine_error = CLOSE * half_error * half_inverse + point.normal_error + COSINE_ROUNDINGS * U;
        let near = (back_2 * back_inverse > CLOSE_FROM * back_error)
            & (half_2 * half_inverse > CLOSE_FROM * half_error);
        doubt |= !near | (material.power == 0u);
        if cosine > -cosine_error {
            // The upper end of what the cosine may be, and all that lies below it as error.
            let upper = min(cosine + cosine_error, 1.0);
            let glint = material.specular * light.emissivity * power(upper, material.power);
            shade.color += glint;
            let n = f32(material.power);
            shade.error += glint * (min(POWER_SLOPE * n * cosine_error / upper, 1.0) + (n + POWER_ROUNDINGS) * U);
        }
//#else
        if cosine > 0.0 {
            shade.color += material.specular * light.emissivity * pow(min(cosine, 1.0), material.shininess);
        }
//#end
    }
//#end
//#if certified
    if !sure {
        // The light may bring nothing at all, so the whole colour counts as error.
        shade.error += shade.color;
    }
//#end
    return shade;
}
