//! Inversion of a function that falls with the absorbed share of light, channel by channel.

use hairis::simd::Lanes;

/// Distance from the asked colour at which a channel is done; its noise is a tenth.
const NEAR: f32 = 2e-6;
/// Most evaluations within a bracket, which no case of the tests needs.
const MOST_STEPS: usize = 40;
/// Most doublings of the light that is added.
const MOST_DOUBLINGS: usize = 5;

/// Finds the absorbed shares with which `shown` has the asked channels, between 0 and `black`, or from below 0 if light can be added. A channel
/// that is out of reach has the share at the nearer end.
///
/// False position after Illinois, for three channels at a time: each keeps a bracket, so that a function that falls is inverted whatever
/// its shape.
pub(super) fn solve<E>(
    asked: [f32; 3],
    black: f32,
    can_add: bool,
    shown: &mut dyn FnMut([f32; 3]) -> Result<[f32; 3], E>,
) -> Result<[f32; 3], E> {
    let minus = |a: [f32; 3]| [0, 1, 2].map(|c| a[c] - asked[c]);
    let (mut lo, mut hi) = ([0.0_f32; 3], [black; 3]);
    let mut above = minus(shown(lo)?);
    let mut step = 0.5;
    for _ in 0..MOST_DOUBLINGS {
        if !can_add || above.iter().all(|x| *x >= 0.0) {
            break;
        }
        for c in 0..3 {
            if above[c] < 0.0 {
                (hi[c], lo[c]) = (lo[c], lo[c] - step);
            }
        }
        step += step;
        above = minus(shown(lo)?);
    }
    let mut below = minus(shown(hi)?);
    let mut done = [false; 3];
    let mut at = [0.0_f32; 3];
    for c in 0..3 {
        // Out of reach, or at an end.
        if above[c] <= 0.0 {
            (at[c], done[c]) = (lo[c], true);
        } else if below[c] >= 0.0 {
            (at[c], done[c]) = (hi[c], true);
        }
    }
    let mut last = [0_i8; 3];
    for _ in 0..MOST_STEPS {
        if done.iter().all(|done| *done) {
            break;
        }
        for c in 0..3 {
            if !done[c] {
                let share = f32::quotient(above[c], (above[c] - below[c]).max(1e-30));
                // Colours of numbers that overflow are none.
                let share = if share.is_finite() { share } else { 0.5 };
                at[c] = lo[c] + (hi[c] - lo[c]) * share;
            }
        }
        let here = minus(shown(at)?);
        for c in 0..3 {
            let is_between = lo[c] < at[c] && at[c] < hi[c];
            if done[c] || here[c].abs() < NEAR || !is_between {
                done[c] = true;
            } else if here[c] > 0.0 {
                (lo[c], above[c]) = (at[c], here[c]);
                // An end that stays would keep the other side from closing in.
                below[c] *= if last[c] == 1 { 0.5 } else { 1.0 };
                last[c] = 1;
            } else {
                (hi[c], below[c]) = (at[c], here[c]);
                above[c] *= if last[c] == -1 { 0.5 } else { 1.0 };
                last[c] = -1;
            }
        }
    }
    Ok(at)
}
