//! Small texts whose lowering shows a rule.

use expect_test::expect;

use super::module::Told;
use super::texts::lowered;

/// The function `asked`, lowered.
fn asked(wgsl: &str) -> String {
    let told = Told {
        double: false,
        roots: &["asked"],
        by_hand: &[],
        uniform: &[],
        apart: &[],
        unmasked: &["stores"],
        identity: &[],
        objects: "objects",
        records: &[],
    };
    let text = lowered("A test", wgsl, told);
    text[text.find("#[inline(always)]\npub(super) fn asked").unwrap()..].into()
}

#[test]
fn what_is_kept_from_round_to_round_is_kept_for_lanes_that_are_off() {
    // `all` is looked at in the inner loop alone, but again in the next round of the outer one; `fresh` is not.
    let text = asked(
        "fn asked(rounds: u32) -> u32 {
            var all = 0u;
            var i = rounds;
            loop {
                if i == 0u {
                    break;
                }
                var k = i;
                loop {
                    if k == 0u || all > 9u {
                        break;
                    }
                    var fresh = k;
                    fresh += all;
                    all += fresh;
                    k -= 1u;
                }
                i -= 1u;
            }
            return i;
        }",
    );
    let stores: String = text
        .lines()
        .filter(|line| line.trim().starts_with("all") || line.trim().starts_with("fresh"))
        .map(|line| format!("{}\n", line.trim()))
        .collect();
    expect![[r#"
        fresh = k;
        fresh = fresh + all;
        all.set(on, all + fresh);
    "#]]
    .assert_eq(&stores);
}

/// What has no meaning for lanes is an error, not another meaning.
#[test]
fn what_would_mean_something_else_is_an_error() {
    for (body, why) in [
        (
            "switch a { case 1u, 2u: { b = 3u; } default: {} }",
            "a case of several values",
        ),
        (
            "loop { switch a { case 1u: { b = 3u; break; } default: {} } if b > 2u { break; } }",
            "with a break",
        ),
        (
            "for (var i = 0u; i < 4u; i++) { if i == 2u { continue; } b += a; }",
            "a round that all lanes leave early",
        ),
        (
            "for (var i = 0u; i < 4u; i++) { if (i == 2u) | (i > STEPS_LIMIT) { b += a; } }",
            "more than the limit on steps",
        ),
        ("b = stores(a);", "stores for all lanes"),
    ] {
        let wgsl = format!(
            "const STEPS_LIMIT = 9u;
            fn stores(c: u32) -> u32 {{ return c; }}
            fn asked(a: u32) -> u32 {{ var b = 0u; {body} return b; }}"
        );
        let panics = std::panic::catch_unwind(|| asked(&wgsl)).unwrap_err();
        let said = panics.downcast_ref::<String>().unwrap();
        assert!(said.contains(why), "{body}: {said}");
    }
}
