//! Scenes with lights on the command line: what probe shows of their rays and samples.

use super::desk::{Desk, LIT, ppm};

/// A folder with the lit room, and its picture rendered on the CPU with these options.
pub(super) fn rendered(options: &[&str]) -> (Desk, Vec<u8>) {
    let desk = Desk::new();
    desk.write("lit.txt", LIT);
    let args = ["render", "lit.txt", "--backend", "cpu", "-o", "-", "-q"];
    let picture = desk.run(&[&args[..], options].concat()).ends(0).stdout;
    (desk, picture)
}

/// The last line that probe prints of a pixel with these bytes.
fn bytes_line(picture: &[u8], x: usize, y: usize) -> String {
    let (width, height, bytes) = ppm(picture);
    let at = 3 * ((height as usize - 1 - y) * width as usize + x);
    format!(
        "bytes        {} {} {}\n",
        bytes[at],
        bytes[at + 1],
        bytes[at + 2]
    )
}

/// The three numbers in brackets behind `what`.
fn three(line: &str, what: &str) -> [f64; 3] {
    let (_, rest) = line
        .split_once(what)
        .unwrap_or_else(|| panic!("no {what} in {line}"));
    let inside = rest
        .trim_start()
        .strip_prefix('(')
        .and_then(|r| r.split_once(')'));
    let numbers: Vec<f64> = inside
        .unwrap()
        .0
        .split(", ")
        .map(|n| n.trim().parse().unwrap())
        .collect();
    numbers.try_into().unwrap()
}

#[test]
fn probe_agrees_with_the_picture_under_light() {
    let options: [&[&str]; 4] = [
        &[],
        &["--max-path", "11", "--screen-tolerance", "0.01"],
        &["--samples", "4"],
        &["--samples", "3", "--jitter", "course", "--size", "20x15"],
    ];
    for options in options {
        let (desk, picture) = rendered(options);
        for (x, y) in [(0, 0), (19, 14), (10, 3), (9, 5), (13, 9), (4, 12)] {
            let (column, row) = (x.to_string(), y.to_string());
            let args = [&["probe", "lit.txt", &column, &row], options].concat();
            let text = desk.run(&args).ends(0).text();
            let expected = bytes_line(&picture, x, y);
            assert!(
                text.contains(&format!("\n{expected}")),
                "{args:?}: no {expected:?} in {text}"
            );
        }
    }
}

#[test]
fn the_rays_of_a_pixel_add_up_to_its_colour() {
    let (desk, _) = rendered(&[]);
    // Through the ball, with a mirror image in it, and one of that.
    let text = desk
        .run(&["probe", "lit.txt", "22", "14", "--all"])
        .ends(0)
        .text();
    for words in [
        "  0 primary: ball (sphere) at ",
        "    1 through 0: wall (plane) at ",
        " mirror in 0: ",
        "material glass, ambient (1, 1, 1)",
        "lamp  diffuse (",
        ", glint (",
        ", filter (0.5, 0.125, 0.125)",
        "spot  nothing: the point is outside its cone",
        "nothing: the surface faces away from it",
        "\nin all       ",
        " found nothing",
        "\ntimes 255    (",
    ] {
        assert!(text.contains(words), "no {words:?} in {text}");
    }
    let mut sum = [0.0; 3];
    for line in text
        .lines()
        .filter(|line| line.trim_start().starts_with("adds "))
    {
        let adds = three(line, "adds");
        (0..3).for_each(|i| sum[i] += adds[i]);
    }
    let colour = three(&text, "\ncolour ");
    assert!((0..3).all(|i| (sum[i] - colour[i]).abs() < 1e-8), "{text}");
    let times = three(&text, "\ntimes 255 ");
    assert!(
        (0..3).all(|i| (times[i] - 255.0 * colour[i]).abs() < 1e-8),
        "{text}"
    );
}

#[test]
fn what_keeps_light_off_is_named() {
    let desk = Desk::new();
    let probe = |scene: &str, options: &[&str]| {
        desk.write("lit.txt", scene);
        desk.run(&[&["probe", "lit.txt", "1", "1"], options].concat())
            .ends(0)
            .text()
    };
    desk.write("t.ppm", "P6 1 1 255\nabc");
    // The ray runs from (1, 1, 2) along −z to the wall at (1, 1, −4).
    let wall = "camera c { pixeldim 3 3 worlddim 2 2 viewpoint 1 1 2 }
        material m { ambient 1 1 1 diffuse 1 1 1 } material g { transparency 0.25 specular 1 }
        plane wall { material m normal 0 0 1 point 0 0 -4 }\n";
    let text = probe(
        &format!(
            "{wall} sphere pea {{ material m center 1.5 1 -2 radius 0.3 }}
            light here {{ location 1 1 -4 emissivity 1 1 1 }}
            light behind {{ location 1 1 -5 emissivity 1 1 1 }}
            light shaded {{ location 2 1 0 emissivity 1 1 1 }}
            spotlight aside {{ location 0 1 0 emissivity 1 1 1 point 0 1 -4 theta 1 }}
            texture t {{ filename t.ppm }}
            projector past {{ location 0 1 0 emissivity 1 1 1 normal 0 0 1 point 2 0 -1 xdir 1 0 0 dimensions 1 2
                             texname t mode 0 }}
            light seen {{ location 1 1 0 emissivity 4 8 0 }}"
        ),
        &[],
    );
    for words in [
        "here    nothing: the light is at this very point\n",
        "behind  nothing: the surface faces away from it\n",
        "shaded  nothing: in the shadow of pea\n",
        "aside   nothing: the point is outside its cone\n",
        "past    nothing: the point is outside its picture\n",
        "seen    diffuse (1, 2, 0)\n",
        "in all       1 ray: 1 met something, 0 found nothing\n",
    ] {
        assert!(text.contains(words), "no {words:?} in {text}");
    }
    // Two mirrors that face each other, up to where the path is too long; one of them lets light through.
    let text = probe(
        &format!(
            "{wall} plane pane {{ material g normal 0 0 1 point 0 0 -1 }}
            sphere mirror {{ material g center 1 1 -2.5 radius 0.5 }}
            light l {{ location 1 3 0 emissivity 1 1 1 }}"
        ),
        &["--max-path", "6"],
    );
    for words in [
        "0 primary: pane (plane) at (1, 1, -1), t = 3\n",
        "1 through 0: mirror (sphere) at (1, 1, -2), t = 1\n",
        "2 through 1: wall (plane) at (1, 1, -4), t = 2\n",
        " mirror in 1: pane (plane) at (1, 1, -1), t = 1\n",
        "nothing\n",
    ] {
        assert!(text.contains(words), "no {words:?} in {text}");
    }
    let text = probe(
        &format!(
            "{wall} plane pane {{ material g normal 0 0 1 point 0 0 -1 }}
            light l {{ location 1 3 0 emissivity 1 1 1 }}"
        ),
        &["--max-path", "2.5"],
    );
    let words = "– through 0: not followed, the path to there is 3, longer than 2.5\n";
    assert!(text.contains(words), "no {words:?} in {text}");
    assert!(
        text.contains("2 not followed: their paths are longer than 2.5\n"),
        "{text}"
    );
}

#[test]
fn a_rectangle_says_where_it_is_missed() {
    let (desk, _) = rendered(&[]);
    let text = desk.run(&["probe", "lit.txt", "30", "25"]).ends(0).text();
    let words = "frame  fplane       miss  its plane is met outside the rectangle: at 7.30769231 along xdir, \
                 where it reaches from 0 to 2\n";
    assert!(text.contains(words), "{text}");
}

#[test]
fn of_a_large_tree_the_first_rays_are_shown() {
    let desk = Desk::new();
    desk.write("halves.txt", &halves());
    let ran = desk.run(&["probe", "halves.txt", "2", "1"]).ends(2);
    let text = ran.text();
    let shown = |text: &str| {
        text.lines()
            .filter(|line| line.contains("material half"))
            .count()
    };
    assert!((100..=200).contains(&shown(&text)), "{text}");
    assert!(text.contains(" more (--all shows them)\n"), "{text}");
    assert!(
        ran.stderr
            .contains("plumb: error: pixel (2, 1) needs more than 65536 rays"),
        "{}",
        ran.stderr
    );
    let few = ["probe", "halves.txt", "2", "1", "--max-path", "10"];
    let text = desk.run(&few).ends(0).text();
    let all = desk.run(&[&few[..], &["--all"]].concat()).ends(0).text();
    assert!(
        shown(&text) <= 200 && shown(&all) > 300 && !all.contains("--all"),
        "{all}"
    );
    // The rest is the same.
    assert_eq!(text.lines().last(), all.lines().last());
}

/// Three half-transparent mirrors, a quarter apart.
fn halves() -> String {
    let planes: String = (1..4)
        .map(|i| {
            let z = -0.25 * f64::from(i);
            format!("plane p{i} {{ material half normal 0 0 1 point 0 0 {z} }}\n")
        })
        .collect();
    format!(
        "camera c {{ pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }}
        material half {{ ambient 0.01 0.01 0.01 transparency 0.5 specular 0.5 }}
        {planes} light l {{ location 4 3 5 emissivity 1 1 1 }}"
    )
}

#[test]
fn a_tree_with_too_many_rays_is_an_error_that_names_the_pixel() {
    let desk = Desk::new();
    desk.write("halves.txt", &halves());
    for backend in ["cpu", "gpu"] {
        let args = ["render", "halves.txt", "--backend", backend];
        desk.run(&args).fails_with(&[
            "plumb: error: pixel (",
            "needs more than 65536 rays",
            "--max-rays",
            "--max-path",
            "plumb probe SCENE ",
        ]);
        desk.run(&[&args[..], &["--max-path", "9"]].concat())
            .ends(0);
        desk.run(&[&args[..], &["--max-path", "9", "--max-rays", "3"]].concat())
            .fails_with(&["more than 3 rays"]);
    }
    assert_eq!(desk.names(), ["halves.ppm", "halves.txt", "room.txt"]);
}

#[test]
fn samples_are_listed_and_one_can_be_chosen() {
    let (desk, _) = rendered(&[]);
    let probe = |options: &[&str]| desk.run(&[&["probe", "lit.txt", "20", "14"], options].concat());
    let text = probe(&["--samples", "5"]).ends(0).text();
    assert!(
        text.contains("\nsamples      5, spread by a hash\n"),
        "{text}"
    );
    let samples: Vec<&str> = text
        .lines()
        .filter(|line| line.contains("  at ("))
        .collect();
    assert_eq!(samples.len(), 5, "{text}");
    let colours: Vec<[f64; 3]> = samples
        .iter()
        .map(|line| three(line.split_once(")  ").unwrap().1, ""))
        .collect();
    let mean = three(&text, "\ncolour ");
    for i in 0..3 {
        let sum: f64 = colours.iter().map(|colour| colour[i]).sum();
        assert!((sum / 5.0 - mean[i]).abs() < 1e-12, "{text}");
    }
    assert!(
        !text.contains("primary") && text.contains("--sample I"),
        "{text}"
    );
    let text = probe(&["--samples", "5", "--sample", "3"]).ends(0).text();
    assert!(text.contains("\nsample       3 of 5, at ("), "{text}");
    assert_eq!(three(&text, "\nbrings "), colours[3]);
    assert!(text.contains("  0 primary: ball"), "{text}");
    let course = probe(&["--samples", "5", "--jitter", "course"])
        .ends(0)
        .text();
    assert!(course.contains("random()"), "{course}");
    let many = probe(&["--samples", "300"]).ends(0).text();
    assert!(many.contains("… and 100 more (--all lists them)"), "{many}");
    probe(&["--sample", "0"]).fails_with(&["--samples"]);
    probe(&["--samples", "5", "--sample", "5"]).fails_with(&["counted from 0"]);
}

#[test]
fn without_lights_probe_knows_nothing_of_rays() {
    let desk = Desk::new();
    let text = desk.run(&["probe", "room.txt", "20", "14"]).ends(0).text();
    assert!(
        !text.contains("rays") && !text.contains("\ntimes 255"),
        "{text}"
    );
    let options = ["--samples", "2", "--sample", "1"];
    let sampled = desk
        .run(&[&["probe", "room.txt", "20", "14"], &options[..]].concat())
        .ends(0)
        .text();
    assert!(
        sampled.contains("hit          ball at ") && !sampled.contains("rays   "),
        "{sampled}"
    );
}

#[test]
fn the_drgb_of_a_listing_is_the_whole_colour() {
    let (desk, _) = rendered(&[]);
    let bright = LIT.replace(
        "ambient 1 1 1 diffuse 4 1 1",
        "ambient 40 40 40 diffuse 4 1 1",
    );
    desk.write("bright.txt", &bright);
    let args = [
        "render",
        "bright.txt",
        "--backend",
        "cpu",
        "-o",
        "-",
        "-q",
        "--rows",
        "14..15",
    ];
    let ran = desk
        .run(&[&args[..], &["--debug", "pix,drgb"]].concat())
        .ends(0);
    let text = desk
        .run(&["probe", "bright.txt", "22", "14"])
        .ends(0)
        .text();
    assert!(
        text.contains("not followed, nothing that it brings can count"),
        "{text}"
    );
    let listed = ran
        .stderr
        .lines()
        .find(|line| line.starts_with("PIX   22 "))
        .unwrap();
    let drgb = three(&listed.replace("( ", "("), "DRGB:");
    assert!(
        drgb[0] > three(&text, "\ncolour ")[0] + 0.005,
        "{listed} {text}"
    );
}
