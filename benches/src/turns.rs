//! Timing of two calls in turns, stretch by stretch. A ratio is the median of the ratios of all turns.

use std::env;
use std::time::Instant;

/// Returns the number of turns in which a pair is timed: a single one without `--bench`, because Cargo also runs benches as tests.
#[must_use]
pub fn turns() -> usize {
    const TURNS: usize = 301;
    if env::args().any(|word| word == "--bench") {
        TURNS
    } else {
        1
    }
}

/// Returns the time of a call, in ns.
fn stretch(call: &mut impl FnMut()) -> f64 {
    let start = Instant::now();
    call();
    start.elapsed().as_secs_f64() * 1e9
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Times two calls in turns. Returns the medians of the time of `ours`, of the time of `base` and of their ratio. Times are in ns per
/// hit; each call handles `hits` hits.
pub fn pair(turns: usize, hits: usize, mut ours: impl FnMut(), mut base: impl FnMut()) -> [f64; 3] {
    let [mut a, mut b, mut ratio] = [vec![], vec![], vec![]];
    for turn in 0..=turns {
        let (first, second);
        // The order of the two calls changes from turn to turn.
        if turn % 2 == 0 {
            (first, second) = (stretch(&mut ours), stretch(&mut base));
        } else {
            let base = stretch(&mut base);
            (first, second) = (stretch(&mut ours), base);
        }
        // The first turn warms up.
        if turn > 0 {
            a.push(first);
            b.push(second);
            ratio.push(first / second);
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "some thousand")]
    let per = |ns: f64| ns / hits as f64;
    [per(median(&mut a)), per(median(&mut b)), median(&mut ratio)]
}
