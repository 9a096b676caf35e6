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
// They hold the place and what becomes of the pixel in f64; with several samples also the sum of those that are worth
// keeping, its error, and the bits of the samples in it. The list is in one buffer with the pixels, since a driver may
// allow no more buffers than a scene needs anyway.
struct Pixels {
    // Records, those for which there was no room too.
    records: atomic<u32>,
    // Workgroups that take those that f64 is to take.
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
//#if records

// Where the words of a new record begin, of the pixel at this place; 0 where there is no room.
fn new_record(place: u32) -> u32 {
    let record = atomicAdd(&pixels.records, 1u);
    var first = 0u;
    if record < dispatch.room {
        first = record_words(record);
//#if listed
        if record < dispatch.taken {
            atomicMax(&pixels.groups, record / LIST_GROUP + 1u);
        }
//#end
        pixels.words[first] = place;
        pixels.words[first + 1u] = UNDECIDED;
    }
    return first;
}
//#end
