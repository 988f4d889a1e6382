//! Strands added beside those of a file, because files of hair for games hold guides, and the game adds the rest.

use crate::lights::uniform_direction;
use glam::Vec3;
use hairis_instruments::sequence::{Independent, XiSource as _};

/// Number of strands that are added beside each strand of a file, and their distance from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// Strands added beside each strand of the file.
    pub strands: u32,
    /// Largest distance of added strands from their guide, in centimetres.
    pub spread: f32,
}

impl Default for Follow {
    fn default() -> Self {
        Self {
            strands: 0,
            spread: 0.5,
        }
    }
}

impl Follow {
    /// Returns the nodes of all strands about a guide, the guide first. A strand depends on its number, on the number of the guide, and on
    /// the guide.
    pub fn about(
        self,
        guide: usize,
        nodes: &[(Vec3, f32)],
    ) -> impl Iterator<Item = Vec<(Vec3, f32)>> + '_ {
        let along = match nodes {
            [root, next, ..] => (next.0 - root.0).normalize_or_zero(),
            _ => Vec3::ZERO,
        };
        (0..=self.strands).map(move |strand| {
            if strand == 0 {
                return nodes.to_vec();
            }
            let mut xi = Independent::new(guide as u64, u64::from(strand));
            let [root, tip] = [0, 1].map(|_| self.spread * in_ball(xi.next_xi_f32()));
            // Roots stay on the skin, which hair leaves upright.
            let root = root.reject_from_normalized(along);
            let last = nodes.len().saturating_sub(1).max(1) as f32;
            let moved = |(k, (place, radius)): (usize, &(Vec3, f32))| {
                (*place + root.lerp(tip, k as f32 / last), *radius)
            };
            nodes.iter().enumerate().map(moved).collect()
        })
    }
}

/// Maps uniform numbers to a point that is uniform in the unit ball.
fn in_ball([x, y, radius]: [f32; 3]) -> Vec3 {
    libm::cbrtf(radius) * uniform_direction([x, y])
}
