// The entry point: from pixels to rays, from colours to bytes and verdicts. Referee: src/cpu/pixel.rs.
//#if packed

// The words of a workgroup: a word of a file's picture holds bytes of pixels that two invocations made.
var<workgroup> handed: array<u32, WORKGROUP * WORKGROUP>;

// Stores a word of the pixels' buffer.
fn put(at: u32, word: u32) {
//#if records
    pixels.words[at] = word;
//#else
    pixels[at] = word;
//#end
}
//#end
//#if quad

// A pixel's bytes, and its verdict.
fn make_pixel(pixel: vec2i) -> u32 {
    let traced = ray_trace(camera_getdir(pixel));
//#if certified
    let bytes = camera_setpix(traced.color, traced.error) | traced.verdict;
//#if listed
    let place = vec2u(vec2i(pixel.x - i32(dispatch.first.x), i32(dispatch.first.y) - pixel.y));
    if (bytes >= UNDECIDED) & (place.x < dispatch.size.x) {
        new_record(place.y * dispatch.size.x + place.x);
    }
//#end
    return bytes;
//#else
    return camera_setpix(traced.color) | traced.verdict;
//#end
}

//#if packed
// Four pixels side by side, as far as there are any: their bytes, and in words of 16 pixels their verdicts.
@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) here: u32) {
    let column = 4u * id.x;
    var doubts = 0u;
    if (column < dispatch.size.x) & (id.y < dispatch.size.y) {
        // Rows of the picture go down, y goes up.
        let pixel = vec2i(i32(dispatch.first.x + column), i32(dispatch.first.y) - i32(id.y));
        let a = make_pixel(pixel);
        let b = make_pixel(pixel + vec2i(1, 0));
        let c = make_pixel(pixel + vec2i(2, 0));
        let d = make_pixel(pixel + vec2i(3, 0));
        let first = PACKED_WORDS * groups_of_row() * id.y + 3u * id.x;
        put(first, (a & 0xffffffu) | (b << 24u));
        put(first + 1u, ((b >> 8u) & 0xffffu) | (c << 16u));
        put(first + 2u, ((c >> 16u) & 0xffu) | (d << 8u));
        doubts = select(0u, 1u, a >> 24u != 0u) | select(0u, 2u, b >> 24u != 0u) | select(0u, 4u, c >> 24u != 0u)
            | select(0u, 8u, d >> 24u != 0u);
    }
    handed[here] = doubts;
    workgroupBarrier();
    if (column < dispatch.size.x) & (id.y < dispatch.size.y) & (id.x % 4u == 0u) {
        let all = doubts | (handed[here + 1u] << 4u) | (handed[here + 2u] << 8u) | (handed[here + 3u] << 12u);
        put(groups_of_row() * (PACKED_WORDS * dispatch.size.y + id.y) + id.x / 4u, all);
    }
}
//#else
// Four pixels side by side, as far as there are any: one store costs less than four.
@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let column = 4u * id.x;
    if (column >= dispatch.size.x) | (id.y >= dispatch.size.y) {
        return;
    }
    // Rows of the picture go down, y goes up.
    let pixel = vec2i(i32(dispatch.first.x + column), i32(dispatch.first.y) - i32(id.y));
    pixels[id.y * ((dispatch.size.x + 3u) / 4u) + id.x] = vec4u(make_pixel(pixel), make_pixel(pixel + vec2i(1, 0)),
        make_pixel(pixel + vec2i(2, 0)), make_pixel(pixel + vec2i(3, 0)));
}
//#end
//#else
//#if packed

// A pixel's bytes, and its verdict.
fn make_pixel(id: vec2u) -> u32 {
//#else

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= dispatch.size) {
        return;
    }
//#end
    // Rows of the picture go down, y goes up.
    let pixel = vec2i(i32(dispatch.first.x + id.x), i32(dispatch.first.y) - i32(id.y));
    let place = id.y * dispatch.size.x + id.x;
//#if any_object
//#if samples
    var traced: Traced;
    // Samples that are sure; a loop that a driver ends makes fewer.
    var sure = 0u;
//#if partial
    // The same of the samples that are worth keeping should the pixel be doubtful: their bits, and how many they are.
    // What is not among them, for whatever reason, the CPU adds.
    var part: Traced;
    var summed: array<u32, SUMMED_WORDS>;
    var kept = 0u;
//#end
    for (var sample = 0u; sample < SAMPLES; sample += 1u) {
        steps += 1u;
//#if course
        let offset = offsets[place * SAMPLES + sample];
//#else
        let offset = jitter_hash(pixel, sample);
//#end
        let one = ray_trace(camera_getdir(pixel, offset));
        sure += select(0u, 1u, one.verdict == 0u);
//#if partial
        let fine = (one.verdict == 0u) & all(one.error < vec3f(FINE));
        add_sample(&traced, one, one.verdict == 0u);
        add_sample(&part, one, fine);
        summed[sample / 32u] |= select(0u, 1u << (sample % 32u), fine);
        kept += select(0u, 1u, fine);
        if steps > STEPS_LIMIT {
            break;
        }
//#else
        traced.color += one.color * SAMPLE_SHARE;
        traced.error += one.error * SAMPLE_ERROR + SAMPLE_ROUNDINGS * U * traced.color; //~
        if one.verdict != 0u {
            break;
        }
//#end
    }
    traced.verdict = select(UNDECIDED, 0u, sure == SAMPLES);
//#else
    let traced = ray_trace(camera_getdir(pixel));
//#end
//#else
    let traced = Traced();
//#end
//#if certified
//#if any_object
    let bytes = camera_setpix(traced.color, traced.error) | traced.verdict;
//#else
    let bytes = 0u;
//#end
//#else
    let bytes = camera_setpix(traced.color) | traced.verdict;
//#end
//#if partial
    // Where all samples together do not tell, they are of no use.
    let useful = kept < SAMPLES;
//#if listed
    if bytes >= UNDECIDED {
//#else
    if (bytes >= UNDECIDED) & (kept > 0u) & useful {
//#end
        let first = new_record(place);
        if first > 0u {
            let color = bitcast<vec3u>(select(vec3f(0.0), part.color, useful));
            let error = bitcast<vec3u>(select(vec3f(0.0), part.error, useful));
            pixels.words[first + 2u] = color.x;
            pixels.words[first + 3u] = color.y;
            pixels.words[first + 4u] = color.z;
            pixels.words[first + 5u] = error.x;
            pixels.words[first + 6u] = error.y;
            pixels.words[first + 7u] = error.z;
            for (var i = 0u; i < SUMMED_WORDS; i += 1u) {
                pixels.words[first + RECORD_HEAD + i] = select(0u, summed[i], useful);
            }
        }
    }
//#else
//#if listed
    if bytes >= UNDECIDED {
        new_record(place);
    }
//#end
//#end
//#if packed
    return bytes;
}

// The pixels of a row of the workgroup are a group: twelve words of bytes, and one of verdicts.
@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) here: u32,
    @builtin(local_invocation_id) local: vec3u,
) {
    var word = 0u;
    if all(id.xy < dispatch.size) {
        word = make_pixel(id.xy);
    }
    handed[here] = word;
    workgroupBarrier();
    if id.y < dispatch.size.y {
        let group = id.x / PACKED_GROUP;
        if local.x < PACKED_WORDS {
            // Word 0 of three has a pixel and a byte of the next one, word 1 two bytes of each, word 2 the last byte of
            // one, and a pixel.
            let first = here + local.x / 3u;
            let shift = 8u * (local.x % 3u);
            let bytes = ((handed[first] & 0xffffffu) >> shift) | (handed[first + 1u] << (24u - shift));
            put(PACKED_WORDS * (groups_of_row() * id.y + group) + local.x, bytes);
        }
        if local.x == PACKED_WORDS {
            var doubts = 0u;
            for (var i = 0u; i < PACKED_GROUP; i += 1u) {
                doubts |= select(0u, 1u << i, handed[here - PACKED_WORDS + i] >> 24u != 0u);
            }
            put(groups_of_row() * (PACKED_WORDS * dispatch.size.y + id.y) + group, doubts);
        }
    }
}
//#else
//#if records
    pixels.words[place] = bytes;
//#else
//#if values
    pixels[place] = vec4u(bitcast<vec3u>(traced.color), bytes);
//#else
    pixels[place] = bytes;
//#end
//#end
}
//#end
//#end
