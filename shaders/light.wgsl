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
        // Where the product is flushed little is lost (FLUSHED), and `open` says that the glint shines through all the
        // same.
        transmittance *= materials[tile_material(blocker)].tint * material.transparency;
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
    let inverse = barrier1(inverseSqrt(max(toward_2, TINY_SQUARE)));
    let distance = toward_2 * inverse;
//#if certified
    let d = unit_step(barrier(toward * inverse));
//#else
    let d = toward * inverse;
//#end
    var c = dot(d, point.normal);
//#if certified
    let toward_error = point.error + U * (light.size + TOWARD_ROUNDINGS * distance);
    if !(distance > CLOSE_FROM * toward_error) | (inverse > LIGHT_NEAREST) {
        doubt = true;
        return shade;
    }
    let d_error = CLOSE * toward_error * inverse + AIM_ROUNDINGS * U;
    let distance_error = toward_error + LIMIT_ROUNDINGS * U * distance;
    var c_error = d_error + point.normal_error + DOT_ROUNDINGS * U;
//#if low_light
    // The height over the distance: of the point's error only what is along the way to the light counts.
    let low = (bit & point.low_light) != 0u;
    c = select(c, point.height * inverse, low);
    c_error = select(c_error, abs(c) * (HEIGHT_SLOPE * distance_error * inverse + HEIGHT_ROUNDINGS * U), low);
//#end
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
//#if projector
    var passed: Passage;
    if light.projector != 0u {
//#if certified
        passed = passage(projectors[light.projector - 1u], point.group, toward, distance, toward_error);
        sure &= passed.sure;
//#else
        passed = passage(projectors[light.projector - 1u], point.group, toward);
//#end
        if !passed.passes {
            return shade;
        }
    }
//#end
//#if certified
    let way = SecondaryRay(point.position, d, point.error, d_error, 0.0, point.size);
    let blocked = shadow(way, Range(point.group, bit, 0.0, distance, 0.0, distance_error));
    sure &= blocked.sure;
//#else
    let blocked = shadow(SecondaryRay(point.position, d), Range(point.group, bit, 0.0, distance));
//#end
    if !blocked.open {
        return shade;
    }
    var emissivity = light.emissivity;
//#if projector
    if light.projector != 0u {
        emissivity *= passed_texel(projectors[light.projector - 1u], passed);
    }
//#end
    let full = diffuse * emissivity * blocked.transmittance * (inverse * CAMERA_UNIT);
    shade.color = full * max(c, 0.0);
    shade.error = full //~
        * (c_error + max(c, 0.0) * (CLOSE * distance_error * inverse + (LIGHT_ROUNDINGS + blocked.roundings) * U)); //~
//#if glint
    let material = materials[objects[point.object].material];
    if material.shininess > 0.0 {
//#if certified
        // The way back is where the ray came from.
        let half = barrier(d - seen.dir);
        let half_error = seen.dir_error + d_error + HALF_ROUNDINGS * U;
        let most = glint_power(half, half_error, point.normal, point.normal_error, material.shininess);
        let glint = material.specular * emissivity * most.x;
        shade.color += glint;
        shade.error += glint * most.y;
//#if projector
        // One product more, that with the texel.
        shade.error += glint * U;
//#end
//#else
        let back = seen.base - point.position;
        let back_2 = dot(back, back);
        let half = back * inverseSqrt(max(back_2, TINY_SQUARE)) + d;
        let half_2 = dot(half, half);
        let cosine = dot(half, point.normal) * inverseSqrt(max(half_2, TINY_SQUARE));
        if cosine > 0.0 {
            shade.color += material.specular * emissivity * pow(min(cosine, 1.0), material.shininess);
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
