// What the host hands over: a dispatch's record, the scene's buffers, and one for the pixels.

// The rectangle of pixels that this dispatch makes.
struct Dispatch {
//#insert members Dispatch
//#if moving
    // The camera, while it moves: the text stays the same then, and is compiled once.
//#insert members CameraNumbers camera_
//#end
}
//#if records

// Behind the dispatch's pixels comes a list without order of those that are in doubt: records of RECORD_WORDS words.
// They hold the place; where only some samples are sure, the sum of such samples, its error, the bits of the samples in
// it; else what becomes of the pixel. The list is in one buffer with the pixels, since a driver may allow no more
// buffers than a scene needs anyway.
struct Pixels {
    // Records, those for which there was no room too.
    records: atomic<u32>,
    // Workgroups that take them all.
    groups: atomic<u32>,
    words: array<u32>,
}
//#end

//#insert bindings
//#if packed

// Groups of a row of the dispatch, filled up.
fn groups_of_row() -> u32 {
    return (dispatch.size.x + PACKED_GROUP - 1u) / PACKED_GROUP;
}
//#end
//#if records

// Where the words of a record begin.
fn record_words(record: u32) -> u32 {
//#if packed
    return (PACKED_WORDS + 1u) * groups_of_row() * dispatch.size.y + record * RECORD_WORDS;
//#else
    return dispatch.size.x * dispatch.size.y + record * RECORD_WORDS;
//#end
}
//#end
//#if listed

// Lists a pixel in doubt.
fn list_doubt(pixel: vec2i) {
    let place = vec2u(vec2i(pixel.x - i32(dispatch.first.x), i32(dispatch.first.y) - pixel.y));
    if place.x >= dispatch.size.x {
        return;
    }
    let record = atomicAdd(&pixels.records, 1u);
    if record < dispatch.room {
        atomicMax(&pixels.groups, record / LIST_GROUP + 1u);
        pixels.words[record_words(record)] = place.y * dispatch.size.x + place.x;
        pixels.words[record_words(record) + 1u] = UNDECIDED;
    }
}
//#end
