// Where a projector's light to a point passes its picture. Referee: `emissivity` in src/cpu/light.rs.

//#insert struct Projector

// How light comes through a picture.
struct Passage {
    // Whether it does.
    passes: bool,
    sure: bool, //~
    // Where, in texels along both sides.
    index: vec2f,
    errors: vec2f, //~
}

// The way from a projector to the point that it lies at `toward` from, on surface number `group`.
//#if certified
fn passage(projector: Projector, group: u32, toward: vec3f, distance: f32, toward_error: f32) -> Passage {
//#else
fn passage(projector: Projector, group: u32, toward: vec3f) -> Passage {
//#end
    var passage: Passage;
    passage.sure = true; //~
    // A surface in the picture's plane ends the way there.
    if group == projector.group {
        return passage;
    }
    // How far the way goes along the normal, and along both sides.
    let along = barrier(-vec3f(dot(projector.normal, toward), dot(projector.row_0, toward),
        dot(projector.row_1, toward)));
    let beyond = along.x - projector.reach;
//#if certified
    let along_error = toward_error + BEYOND_ROUNDINGS * U * distance;
    let beyond_error = along_error + U * projector.reach;
    if beyond < -beyond_error {
        return passage;
    }
    if !(along.x > CLOSE_FROM * along_error) {
        passage.sure = false;
        doubt = true;
        return passage;
    }
    passage.sure = beyond > beyond_error;
//#else
    if !(beyond > 0.0) {
        return passage;
    }
//#end
    let share = projector.reach / along.x;
    let index = barrier(vec3f(share * along.yz + vec2f(projector.start_0, projector.start_1), 0.0)).xy;
//#if certified
    let stretch = CLOSE * along_error / along.x;
    let errors = projector.errors + share * (abs(along.yz) * stretch
        + projector.row_lengths * (toward_error + PICTURE_ROUNDINGS * U * distance) * (1.0 + stretch));
    let margin = min(index, projector.ends - index);
    if any(margin < -errors) {
        return passage;
    }
    passage.sure &= all(margin > errors);
    passage.errors = errors;
//#else
    if any(index < vec2f(0.0)) | any(index > projector.ends) {
        return passage;
    }
//#end
    passage.passes = true;
    passage.index = index;
    return passage;
}

// The texel that light passes, each channel byte/256.
fn passed_texel(projector: Projector, passage: Passage) -> vec3f {
    let size = vec2f(projector.size);
    let repeats = projector.repeats != 0u;
    let index = passage.index;
//#if certified
    let margin = texel_margin(size, repeats, index, passage.errors);
    certain(vec3f(margin, MOST_INDEX - max(abs(index.x), abs(index.y))));
//#end
    return texel_at(projector.first, projector.size.x, size, repeats, index);
}
