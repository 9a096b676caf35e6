// Planes, and rectangles and triangles of planes. Referee: src/cpu/plane.rs.
//
// What is called for each object has neither branches with two arms nor && and ||, which are such branches: a compiler
// was seen to take twice as long for each of them that stands in a loop (docs/BENCH.md).

//#if plane
//#insert struct Plane

// The plane as a primary ray meets it.
fn plane_hits(plane: Plane, ray: Ray) -> PrimaryIntersection {
    let at = from_pixel(ray, CAMERA_ANCHOR);
    var intersection: PrimaryIntersection;
    intersection.inverse = plane.inverse.x * at.x + plane.inverse.y * at.y + plane.inverse.z;
//#if front
    let side = plane.front.x * at.x + plane.front.y * at.y + plane.front.z;
//#if certified
    intersection.hit = side > plane.front_error;
    intersection.possible = side > -plane.front_error;
//#else
    intersection.hit = side >= 0.0;
//#end
//#else
    intersection.hit = true;
    intersection.possible = true; //~
//#end
    intersection.error = plane.inverse_error; //~
    return intersection;
}
//#end
//#if polygon

//#insert struct Polygon

// The rectangle or triangle as a primary ray meets it.
fn polygon_hits(polygon: Polygon, ray: Ray) -> PrimaryIntersection {
    let at = vec3f(from_pixel(ray, CAMERA_ANCHOR), 1.0);
    let sides = vec4f(dot(polygon.side_0, at), dot(polygon.side_1, at), dot(polygon.side_2, at),
        dot(polygon.side_3, at));
    var intersection: PrimaryIntersection;
    intersection.inverse = dot(polygon.inverse, at);
//#if certified
    intersection.hit = all(sides > polygon.side_errors);
    intersection.possible = all(sides > -polygon.side_errors);
//#else
    intersection.hit = all(sides >= vec4f(0.0));
//#end
//#if front
    let side = dot(polygon.front, at);
//#if certified
    intersection.hit &= side > polygon.front_error;
    intersection.possible &= side > -polygon.front_error;
//#else
    intersection.hit &= side >= 0.0;
//#end
//#end
    intersection.error = polygon.inverse_error; //~
    return intersection;
}
//#end
//#if lit

//#insert struct WorldPlane
//#if triangle_anywhere

// The third side of the triangle whose record says so in `bounded`: within, row·P is at least the fourth component.
fn third_side(bounded: u32) -> vec4f {
//#if double
    let one = objects[THIRD_SIDES + 2u * (bounded - 2u)];
    let two = objects[THIRD_SIDES + 2u * (bounded - 2u) + 1u];
    return vec4f(double_of(one.material, one.kind), double_of(one.group, one.place),
        double_of(two.material, two.kind), double_of(two.group, two.place));
//#else
    let side = objects[THIRD_SIDES + bounded - 2u];
    return bitcast<vec4f>(vec4u(side.material, side.kind, side.group, side.place));
//#end
}
//#end

// The plane as a ray from anywhere meets it.
fn plane_hits_from(plane: WorldPlane, ray: SecondaryRay, range: Range) -> Intersection {
    var intersection: Intersection;
    let ahead = plane.offset - dot(plane.normal, ray.base);
    let along = dot(plane.normal, ray.dir);
    let inverse = 1.0 / along;
    let t = barrier1(ahead * inverse);
    intersection.t = t;
//#if certified
    let ahead_error = ray.base_error + PLANE_ROUNDINGS * U * (abs(plane.offset) + ray.size);
    let along_error = ray.dir_error + PLANE_ROUNDINGS * U;
    // Unless it is seen edge-on, t is known to within `error`.
    let steep = (abs(along) > STEEP * along_error) & (abs(t) < FARTHEST);
    let slope = abs(inverse) * (GROWTH + STEEP_SLOPE * along_error * abs(inverse));
    let error = (ahead_error + abs(t) * along_error) * slope + DISTANCE_ROUNDINGS * U * abs(t);
    let start = error + ray.start_error;
    var out = (steep & (t < -start)) | (plane.group == range.skip) | ((plane.lights_on_surface & range.light) != 0u);
//#if low_light
    // The way to a light on the same side does not cross the plane, however near the light is.
    let above = select(ahead, -ahead, plane.height > 0.0);
    out |= ((plane.low_light & range.light) != 0u) & (above > ahead_error);
//#end
    let in = steep & (t > start) & !out;
    intersection.error = error;
    // A plane seen edge-on is met far away, if at all.
    intersection.low = select(max(abs(ahead) - ahead_error, 0.0) / (abs(along) + along_error) * LOWERED, t - error,
        steep);
//#if transparent
    intersection.high = select(T_MAX, t + error, steep);
//#end
    let position = (ray.base + t * ray.dir) * plane.axis_mask + plane.fixed_coordinate;
    // The position stays on the plane, so that `error` is all that base and dir can move it by.
    let position_error = error + POSITION_ROUNDINGS * U * (ray.size + abs(t));
    let below = plane.highest - position.z;
    out |= in & (below < -position_error);
    var inside = below > position_error;
//#if sides_anywhere
    if plane.bounded != 0u {
        let p = vec2f(dot(plane.row_0, position) - plane.origin_0, dot(plane.row_1, position) - plane.origin_1);
        var margin = min(min(p.x, p.y), min(plane.lengths.x - p.x, plane.lengths.y - p.y));
//#if triangle_anywhere
        if plane.bounded > 1u {
            let third = third_side(plane.bounded);
            margin = min(margin, dot(third.xyz, position) - third.w);
        }
//#end
        let margin_error = SECOND_ORDER * position_error + plane.sides_error
            + PLANE_ROUNDINGS * U * (ray.size + abs(t));
        out |= in & (margin < -margin_error);
        inside &= margin > margin_error;
    }
//#end
    intersection.possible = !out;
    intersection.hit = in & !out & inside;
//#else
    let position = (ray.base + t * ray.dir) * plane.axis_mask + plane.fixed_coordinate;
    // A light in the plane is where the ray meets it: at the light, not before.
    intersection.hit = (t > 0.0) & (position.z <= plane.highest) & (plane.group != range.skip)
        & ((plane.lights_on_surface & range.light) == 0u);
//#if sides_anywhere
    if plane.bounded != 0u {
        let p = vec2f(dot(plane.row_0, position) - plane.origin_0, dot(plane.row_1, position) - plane.origin_1);
        intersection.hit &= all(p >= vec2f(0.0)) & all(p <= plane.lengths);
//#if triangle_anywhere
        if plane.bounded > 1u {
            let third = third_side(plane.bounded);
            intersection.hit &= dot(third.xyz, position) >= third.w;
        }
//#end
    }
//#end
//#end
    return intersection;
}
//#end
