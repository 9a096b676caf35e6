// Instead of the entry point of a picture's shader: the pixels that it listed, again.
//#if listed
//#if partial

// Three f32 of a record, from this word on.
fn known(first: u32) -> vec3f {
    let words = vec3u(pixels.words[first], pixels.words[first + 1u], pixels.words[first + 2u]);
    return vec3f(bitcast<vec3<single>>(words));
}

// A pixel's mean, of what its record knows and the samples that are missing there.
fn complete_mean(first: u32, pixel: vec2i) -> Traced {
    var traced: Traced;
    traced.color = known(first + 2u);
    traced.error = known(first + 5u) * SAMPLE_GROWTH;
    // Samples that were looked at: a loop that a driver ends looks at fewer.
    var seen = 0u;
    for (var sample = 0u; sample < SAMPLES; sample += 1u) {
        steps += 1u;
        if ((pixels.words[first + RECORD_HEAD + sample / 32u] >> (sample % 32u)) & 1u) == 0u {
            let one = ray_trace(camera_getdir(pixel, jitter_hash(pixel, sample)));
            add_sample(&traced, one, one.verdict == 0u);
            if one.verdict != 0u {
                break;
            }
        }
        if steps > STEPS_LIMIT {
            break;
        }
        seen += 1u;
    }
    traced.verdict = select(UNDECIDED, 0u, seen == SAMPLES);
    return traced;
}
//#end

@compute @workgroup_size(LIST_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= min(atomicLoad(&pixels.records), dispatch.taken) {
        return;
    }
    let first = record_words(id.x);
    let place = pixels.words[first];
    let row = place / dispatch.size.x;
    let column = place - row * dispatch.size.x;
    let pixel = vec2i(i32(dispatch.first.x + column), i32(dispatch.first.y) - i32(row));
//#if partial
    let traced = complete_mean(first, pixel);
//#else
    let traced = ray_trace(camera_getdir(pixel));
//#end
    pixels.words[first + 1u] = camera_setpix(traced.color, traced.error) | traced.verdict;
}
//#end
