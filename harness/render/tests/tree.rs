//! Comparison of the tree with a test of every block one by one, on every level.

mod triangles;

use glam::Vec3;
use hairis::simd::Level;
use hairis_render::geometry::{Builder, Flattening, Groom, Kind, Strands};
use hairis_render::tree::{Hit, Meet, Ray, Skip, Tree, TreeError};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// Returns the nearest hit, found by a test of all segments.
fn search_all(tree: &Tree, ray: &Ray) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for hit in tree.every_hit(ray) {
        let ignored = ray
            .skip
            .is_some_and(|skip| skip.strand == hit.strand && hit.t < skip.before);
        let before = |best: Hit| (hit.t, hit.segment) < (best.t, best.segment);
        if hit.t < ray.t_max && !ignored && best.is_none_or(before) {
            best = Some(hit);
        }
    }
    best
}

/// Uniform numbers, from a fixed seed.
struct Numbers(ChaCha8Rng);

impl Numbers {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn number(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / (1 << 24) as f32
    }

    /// Returns a point in a cube of side 2 about the origin.
    fn vector(&mut self) -> Vec3 {
        2.0 * Vec3::new(self.number(), self.number(), self.number()) - 1.0
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    fn index(&mut self, below: usize) -> usize {
        self.0.next_u32() as usize % below
    }
}

/// Returns 2000 segments in strands of 1 to 20, in a cube of side 20, thick enough to be met often.
fn thicket() -> Strands {
    let mut numbers = Numbers::new(1);
    let mut builder = Strands::builder();
    let mut left = 2000;
    while left > 0 {
        let segments = (1 + numbers.index(20)).min(left);
        let mut position = 10.0 * numbers.vector();
        let mut nodes = vec![(position, 0.2 * numbers.number())];
        for _ in 0..segments {
            position += numbers.vector();
            nodes.push((position, 0.2 * numbers.number()));
        }
        builder.push(nodes).expect("finite nodes");
        left -= segments;
    }
    builder.finish()
}

/// Returns a ray from outside or inside, towards a segment, along it, along an axis of the world, or from an axis, of any length.
fn ray(strands: &Strands, segments: &[(u32, u32)], numbers: &mut Numbers) -> Ray {
    let (strand, segment) = segments[numbers.index(segments.len())];
    let s = numbers.number();
    let target = strands.position(segment, s);
    let direction = numbers.direction();
    let ray = match numbers.index(6) {
        0 => Ray::new(
            target + 0.3 * numbers.vector() - 30.0 * direction,
            direction,
        ),
        1 => Ray::new(10.0 * numbers.vector(), direction),
        2 => {
            let edge =
                (strands.position(segment, 1.0) - strands.position(segment, 0.0)).normalize();
            Ray::new(target - 5.0 * edge, edge)
        }
        3 => {
            let axis =
                Vec3::AXES[numbers.index(3)] * if numbers.index(2) == 0 { 1.0 } else { -1.0 };
            Ray::new(target - 15.0 * axis, axis)
        }
        4 => {
            let mut direction = direction;
            direction[numbers.index(3)] = if numbers.index(2) == 0 { 0.0 } else { -0.0 };
            Ray::new(target - 3.0 * direction.normalize(), direction.normalize())
        }
        _ => {
            let across = strands.tangent(segment, s).cross(direction).length();
            Ray {
                skip: Some(Skip::leaving(
                    strand,
                    strands.radius(segment, s),
                    across,
                    Meet::Axis,
                )),
                ..Ray::new(target, direction)
            }
        }
    };
    if numbers.index(4) == 0 {
        Ray {
            t_max: 20.0 * numbers.number(),
            ..ray
        }
    } else {
        ray
    }
}

#[test]
fn tree_finds_what_a_search_of_all_finds() {
    let strands = thicket();
    let segments: Vec<(u32, u32)> = strands.numbers().collect();
    assert_eq!(segments.len(), 2000, "segments");
    let levels = Level::available().map(|level| (level, Meet::Axis));
    for (level, meet) in levels.chain([(Level::detect(), Meet::Surface)]) {
        let tree = Tree::build(&strands).expect("a small scene");
        let tree = tree.at(level).with_meet(meet);
        let mut numbers = Numbers::new(2);
        let (mut hits, mut beyond) = (0, 0);
        for i in 0..10_000 {
            let ray = ray(&strands, &segments, &mut numbers);
            let expected = search_all(&tree, &ray);
            assert_eq!(tree.closest(&ray), expected, "ray {i} on {level}: {ray:?}");
            assert_eq!(
                tree.occluded(&ray),
                expected.is_some(),
                "ray {i} on {level}: {ray:?}"
            );
            hits += usize::from(expected.is_some());
            // Limits and strands to skip count: without them there are more hits.
            beyond += usize::from(
                expected.is_none() && tree.occluded(&Ray::new(ray.origin, ray.direction)),
            );
        }
        assert!(
            (5_000..9_900).contains(&hits) && beyond > 500,
            "{hits} hits, {beyond} beyond limits on {level}, {meet:?}"
        );
    }
}

#[test]
fn hits_end_before_t_max_and_begin_after_the_origin() {
    let mut builder = Builder::default();
    builder
        .push([(Vec3::NEG_X, 0.5), (Vec3::X, 0.5)])
        .expect("a cylinder");
    let tree = Tree::build(&builder.finish()).expect("a small scene");
    let from = |y: f32, t_max: f32| Ray {
        t_max,
        ..Ray::new(Vec3::new(0.0, y, 0.0), Vec3::NEG_Y)
    };
    assert_eq!(tree.closest(&from(2.0, 2.0)), None, "at t_max itself");
    assert!(!tree.occluded(&from(2.0, 2.0)), "at t_max itself");
    assert_eq!(
        tree.closest(&from(2.0, 2.0_f32.next_up())).map(|hit| hit.t),
        Some(2.0),
        "just before t_max"
    );
    assert_eq!(tree.closest(&from(0.0, 9.0)), None, "from the axis itself");
    assert_eq!(
        tree.closest(&from(0.25, 9.0)).map(|hit| hit.t),
        Some(0.25),
        "from within the radius"
    );
    let skipping = |before| Ray {
        skip: Some(Skip { strand: 0, before }),
        ..from(0.25, 9.0)
    };
    assert_eq!(
        tree.closest(&skipping(0.3)),
        None,
        "the strand that the ray leaves"
    );
    assert!(
        tree.closest(&skipping(0.25)).is_some(),
        "as far as the ray has left it"
    );
}

#[test]
fn equal_segments_go_by_number() {
    let mut builder = Strands::builder();
    for _ in 0..1000 {
        builder
            .push([(Vec3::NEG_X, 0.1), (Vec3::X, 0.1)])
            .expect("a cylinder");
    }
    let strands = builder.finish();
    let tree = Tree::build(&strands).expect("a small scene");
    let mut ray = Ray::new(Vec3::new(0.1, 0.05, 3.0), Vec3::NEG_Z);
    assert_eq!(
        tree.closest(&ray).map(|hit| hit.segment),
        Some(0),
        "the first of equal ones"
    );
    ray.skip = Some(Skip {
        strand: 0,
        before: 4.0,
    });
    assert_eq!(
        tree.closest(&ray).map(|hit| (hit.strand, hit.segment)),
        Some((1, 2)),
        "the first that is not skipped"
    );
    assert_eq!(tree.size().blocks, 125, "blocks are full");
}

#[test]
fn small_scenes() {
    let ray = Ray::new(Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y);
    let empty = Tree::build(&Strands::builder().finish()).expect("no scene is too small");
    assert_eq!(empty.closest(&ray), None, "nothing to meet");
    assert!(!empty.occluded(&ray), "nothing to meet");
    for segments in [1, 7, 8, 9, 64, 65] {
        let mut builder = Strands::builder();
        builder
            .push((0..=segments).map(|k| (Vec3::new(k as f32 - 0.5, 0.0, 0.0), 0.1)))
            .expect("a cylinder");
        let tree = Tree::build(&builder.finish()).expect("a small scene");
        for k in 0..segments {
            let ray = Ray::new(Vec3::new(k as f32, 5.0, 0.05), Vec3::NEG_Y);
            let hit = tree.closest(&ray).expect("within the radius");
            assert_eq!((hit.segment, hit.strand), (k, 0), "of {segments}");
        }
    }
}

#[test]
fn thin_scenes_are_refused() {
    let scene = |length: f32| {
        let mut builder = Strands::builder();
        builder
            .push([(Vec3::ZERO, 0.001), (Vec3::X * length, 0.0)])
            .expect("a cone");
        Tree::build(&builder.finish())
    };
    assert!(scene(99.0).is_ok(), "1e5 radii");
    let error = scene(101.0).expect_err("more than 1e5 radii");
    assert!(
        matches!(error, TreeError::Scale { radius: 0.001, .. }),
        "{error}"
    );
    assert!(
        error.to_string().contains("101") && error.to_string().contains("0.001"),
        "{error}"
    );
}

#[test]
fn strands_and_trees_are_the_same_for_any_number_of_threads() {
    let groom = Groom::new(Kind::Curly, 400);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let strands = groom
                .grow(&Flattening::default())
                .expect("settings in range");
            let tree = Tree::build(&strands).expect("a small scene");
            (strands, format!("{tree:?}"))
        })
    };
    let one = with(1);
    assert!(
        one.0.segments() > 40_000,
        "enough for sets to be looked at in parallel: {}",
        one.0.segments()
    );
    for threads in [2, 7] {
        assert!(with(threads) == one, "{threads} threads");
    }
}
