//! Heads under hair from a file: meshes and fitted ellipsoids.

use crate::support::{distance, film, hair, mean};
use glam::Vec3;
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_render::formats::{Head as Options, Up, import_head, import_head_bytes};
use hairis_render::geometry::{Flattening, Groom, HEAD, Kind, Mesh, Strands};
use hairis_render::scalp::fit;
use hairis_render::scene::{Ellipsoid, Head, Scene};
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::transport::{Integrator, Mis, Settings};
use std::path::Path;

const AS_IT_IS: Options = Options {
    scale: 1.0,
    up: Up::Y,
};

fn read(name: &str, file: &str) -> Result<Mesh, String> {
    import_head_bytes(Path::new(name), file.as_bytes(), &AS_IT_IS)
        .map_err(|error| error.to_string())
}

/// Mesh of a quad and a triangle.
const OBJ: &str = "# \n mtllib none.mtl\no one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nusemtl skin\nf 1//1 2//1 3//1 4//1\n\
    g two\nv 0 0 2 1 0 0\nf -1 1 2\nl 1 2\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
    property uchar flags\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 2\n0 4 0 1 2 3\n0 3 4 0 1\n";

#[test]
fn meshes_are_read() {
    for (name, file) in [
        ("a.obj", OBJ),
        ("a.ply", PLY),
        ("a.obj", PLY),
        ("mesh", OBJ),
    ] {
        let mesh = read(name, file).expect("a mesh");
        assert_eq!(mesh.triangles(), 3, "{name}");
        assert_eq!(
            mesh.corners(2),
            [Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, Vec3::X]
        );
        assert_eq!(
            (mesh.normal(0), mesh.normal(1)),
            (Vec3::Z, Vec3::Z),
            "{name}"
        );
        assert_eq!(mesh.bounds().hi, Vec3::new(1.0, 1.0, 2.0), "{name}");
    }
    let options = Options {
        scale: 100.0,
        up: Up::Z,
    };
    let mesh = import_head_bytes(Path::new("a.ply"), PLY.as_bytes(), &options).expect("a mesh");
    assert_eq!(
        mesh.corners(2)[0],
        Vec3::new(0.0, 200.0, 0.0),
        "metres, z up"
    );
}

#[test]
fn statements_of_obj_go_on_and_end_in_comments() {
    let plain = read("a.obj", OBJ).expect("a mesh");
    let after = |line: &str, more: &str| OBJ.replace(line, &format!("{line}{more}"));
    for file in [
        OBJ.replace("f -1 1 2", "f -1 \\\n 1 \\\n\\\n2"),
        OBJ.replace("f -1 1 2", "f\\\n-1 1\\\n2"),
        OBJ.replace("f -1 1 2", "f -1 1 \\ # and\n2 # cheek"),
        OBJ.replace("f -1 1 2", "f -1 1 \\ \t\r\n2"),
        OBJ.replace("v 1 1 0", "v 1 \\\n1 0"),
        OBJ.replace(' ', "\\\n"),
        OBJ.replace('\n', " # v 9 9 9\n"),
        OBJ.replace('\n', "# f 1 2 9\r\n"),
        OBJ.replace('\n', "\r"),
        // A comment and an empty line end a statement, a backslash in a comment does not continue it.
        after("usemtl skin", " \\\n\nf 1 2 3 4\n# C:\\hair\\")
            .replace("f 1//1 2//1 3//1 4//1\n", ""),
        after("g two", " \\\nf 9 9 9"),
        OBJ.replace("f -1 1 2", "f -1/2/3 +1/x 2//"),
        format!("\u{feff}{}", &OBJ[3..]),
        OBJ.trim_end().to_owned() + "\\",
    ] {
        assert_eq!(read("a.obj", &file).as_ref(), Ok(&plain), "{file:?}");
    }
    let umlaut = [b"# \xfc\\\n", OBJ.as_bytes(), b"g \xe4 # \xf6"].concat();
    let mesh = import_head_bytes(Path::new("a.obj"), &umlaut, &AS_IT_IS).expect("a mesh");
    assert_eq!(mesh, plain, "names are in any encoding");
}

#[test]
fn each_fault_of_obj_has_its_own_sentence() {
    let nowhere = |word: &str| {
        format!("a corner must be one of the 5 vertices before the face, got {word:?} in ")
    };
    let number = |word: &str| {
        format!("a corner must begin with the whole number of a vertex, got {word:?} in ")
    };
    let corners = |count| format!("a face must have at least three corners, got {count} in ");
    let far = "99999999999999999999";
    for (statement, problem) in [
        ("f 9 1 2", nowhere("9")),
        ("f 0 1 2", nowhere("0")),
        ("f 1 -6/1 2", nowhere("-6/1")),
        (&format!("f 1 2 {far}"), nowhere(far)),
        (&format!("f 1 2 -{far}"), nowhere(&format!("-{far}"))),
        ("f 1 two 3", number("two")),
        ("f 1 2.0 3", number("2.0")),
        ("f 1 2 /3", number("/3")),
        ("f 1 2 \\ 3", number("\\")),
        ("f 1 2", corners(2)),
        ("f", corners(0)),
        (
            "v 1 2",
            "a vertex must have three coordinates, got 2 in ".to_owned(),
        ),
        (
            "v 1 one 0",
            "a coordinate must be a number, got \"one\" in ".to_owned(),
        ),
    ] {
        for more in ["", " # cheek", " \\\n# cheek"] {
            let file = OBJ.replace("f -1 1 2", &format!("{statement}{more}"));
            let error = read("a.obj", &file).expect_err(statement);
            assert_eq!(
                error,
                format!("a.obj: byte 121: {problem}{statement:?}"),
                "{file:?}"
            );
        }
    }
    let long = OBJ.replace("f -1 1 2", &format!("f {}", "one ".repeat(999)));
    let error = read("a.obj", &long).expect_err("no number");
    assert!(error.len() < 200 && error.ends_with("\"..."), "{error}");
    let error = read("a.obj", &OBJ.replace("v 1 1 0", "v 1 nan 0")).expect_err("no number");
    assert_eq!(
        error,
        "a.obj: byte 42: coordinates must be finite and at most 1e6, got NaN"
    );
}

#[test]
fn wrong_meshes_are_refused_in_one_line() {
    let cases = [
        (
            "a.obj",
            OBJ.replace("f ", "# "),
            "a mesh must have from 1 to 2^31 - 1 triangles with an area, got 0",
        ),
        (
            "a.obj",
            "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".to_owned(),
            "with an area, got 0",
        ),
        (
            "a.obj",
            String::new(),
            "byte 0: a head must be a mesh, PLY or OBJ, got no vertex",
        ),
        (
            "a.ply",
            PLY.replace("0 3 4 0 1", "0 3 4 0 5"),
            "must be whole and below 5, got 5",
        ),
        (
            "a.ply",
            PLY.replace("0 3 4 0 1", "0 3 4 0"),
            "row 1 of the 2 of `face` is too short",
        ),
        (
            "a.ply",
            PLY.replace("element face", "element faces"),
            "a head must be a mesh: an element `face`",
        ),
        (
            "a.ply",
            PLY.replace("1 1 0", "1 inf 0"),
            "coordinates must be finite",
        ),
    ];
    for (name, file, expected) in cases {
        let error = read(name, &file).expect_err(expected);
        assert!(
            error.starts_with(name) && error.contains(expected) && !error.contains('\n'),
            "{error} for {expected}"
        );
    }
    let error = import_head(Path::new("none.obj"), &AS_IT_IS).expect_err("no file");
    assert!(
        error.to_string().starts_with("none.obj: cannot be read"),
        "{error}"
    );
    let nothing = Options {
        scale: 0.0,
        ..AS_IT_IS
    };
    let error =
        import_head_bytes(Path::new("a.ply"), PLY.as_bytes(), &nothing).expect_err("no size");
    assert!(error.to_string().contains("`head-scale`"), "{error}");
}

/// Returns an ellipsoid of many triangles.
fn mesh(Ellipsoid { centre, radii }: Ellipsoid, rings: u32) -> Mesh {
    let around = 2 * rings;
    let place = |ring: u32, k: u32| {
        let theta = core::f32::consts::PI * ring as f32 / rings as f32;
        let phi = core::f32::consts::TAU * k as f32 / around as f32;
        centre
            + radii
                * Vec3::new(
                    theta.sin() * phi.cos(),
                    theta.cos(),
                    theta.sin() * phi.sin(),
                )
    };
    let places = (0..=rings).flat_map(|ring| (0..around).map(move |k| place(ring, k)));
    let number = |ring: u32, k: u32| ring * around + k % around;
    let quads = (0..rings).flat_map(|ring| (0..around).map(move |k| (ring, k)));
    let triangles = quads.flat_map(|(ring, k)| {
        let [a, b] = [number(ring, k), number(ring, k + 1)];
        let [c, d] = [number(ring + 1, k), number(ring + 1, k + 1)];
        [[a, b, c], [b, d, c]]
    });
    Mesh::new(places.collect(), triangles.collect()).expect("a ball")
}

/// Returns a head below hair that stands away from it, as if the hair were from a file.
fn scene(head: Option<Head>) -> Scene {
    let strands = Groom::new(Kind::Fur, 400)
        .grow(&Flattening::default())
        .expect("in range");
    let parts = Parts {
        strands,
        imported: true,
        head,
        hair: hair("gaussian", "matched", "brown"),
        env: None,
        size: [24, 24],
        turn: 30.0,
    };
    scenes::build(Name::Env, parts).expect("a scene")
}

#[test]
fn a_mesh_shades_as_the_ellipsoid_that_it_is() {
    let ellipsoid = Ellipsoid {
        centre: Vec3::ZERO,
        radii: 0.98 * HEAD,
    };
    let [mut none, mut smooth, facets] = [
        None,
        Some(Head::ellipsoid(ellipsoid)),
        Some(Head::mesh(mesh(ellipsoid, 200))),
    ]
    .map(scene);
    // A mesh counts for the frame of the picture, an ellipsoid that was fitted to the hair does not.
    (none.camera, smooth.camera) = (facets.camera, facets.camera);
    for (integrator, mis) in [
        (Integrator::Path, Mis::Both),
        (Integrator::Path, Mis::Resampled),
        (Integrator::Gather, Mis::Resampled),
    ] {
        let settings = Settings {
            integrator,
            mis,
            ..Settings::default()
        };
        let [none, smooth, facets] =
            [&none, &smooth, &facets].map(|scene| mean(scene, &settings, 16, 8, 0));
        assert!(
            distance(&smooth, &facets) < 4.0,
            "{mis:?}: {smooth:?} and {facets:?}"
        );
        assert!(
            distance(&none, &facets) > 8.0,
            "{mis:?}: {none:?} and {facets:?}"
        );
    }
}

#[test]
fn a_white_mesh_in_a_white_sphere_does_not_show() {
    let ellipsoid = Ellipsoid {
        centre: Vec3::ZERO,
        radii: HEAD,
    };
    let head = Head {
        albedo: Vec3::ONE,
        ..Head::mesh(mesh(ellipsoid, 30))
    };
    let mut scene = scene(Some(head));
    scene.sky = hairis_instruments::light::Constant.into();
    // No hair, whose albedo is below 1.
    scene.strands = Strands::builder().finish();
    scene.tree = hairis_render::tree::Tree::build(&scene.strands).expect("nothing");
    let settings = Settings {
        mis: Mis::Bsdf,
        ..Settings::default()
    };
    let picture = film(&scene, &settings, 4).picture();
    assert!(
        picture.mean().iter().all(|mean| (mean - 1.0).abs() < 1e-5),
        "{:?}",
        picture.mean()
    );
}

/// Returns strands that begin at these places.
fn roots(places: impl IntoIterator<Item = Vec3>) -> Strands {
    let mut builder = Strands::builder();
    for place in places {
        builder
            .push([(place, 0.01), (place + Vec3::Y, 0.01)])
            .expect("finite");
    }
    builder.finish()
}

/// Returns roots on the part of an ellipsoid above `lowest` of its height, `noise` of its size off the
/// surface.
fn on(ellipsoid: Ellipsoid, count: usize, lowest: f32, noise: f32) -> Vec<Vec3> {
    let mut xi = Independent::new(9, 0);
    (0..count)
        .map(|_| {
            let [height, around, off] = xi.next_xi_f32::<3>();
            let y = lowest + (1.0 - lowest) * height;
            let (sin, cos) = (core::f32::consts::TAU * around).sin_cos();
            let across = (1.0 - y * y).max(0.0).sqrt();
            let off = 1.0 + noise * (2.0 * off - 1.0);
            ellipsoid.centre + off * ellipsoid.radii * Vec3::new(across * cos, y, across * sin)
        })
        .collect()
}

#[test]
fn the_scalp_is_found() {
    let ellipsoid = Ellipsoid {
        centre: Vec3::new(3.0, 170.0, -2.0),
        radii: Vec3::new(8.0, 11.0, 9.5),
    };
    for (lowest, noise, tolerance) in [(-0.25, 0.0, 0.01), (0.2, 0.0, 0.02), (-0.25, 0.02, 0.03)] {
        let places = on(ellipsoid, 3000, lowest, noise);
        let found = fit(&roots(places.clone())).expect("a scalp");
        let radii = found.ellipsoid.radii / 0.995 / (1.0 - noise);
        let off = (radii - ellipsoid.radii).abs().max_element() / 9.5;
        let moved = found.ellipsoid.centre.distance(ellipsoid.centre) / 9.5;
        assert!(
            off < tolerance && moved < tolerance,
            "{found} above {lowest}: {off} {moved}"
        );
        let below = |root: &&Vec3| {
            ((**root - found.ellipsoid.centre) / found.ellipsoid.radii).length() < 1.0
        };
        assert!(
            places.iter().filter(below).count() < 100,
            "roots are above {found}"
        );
        // Some strands elsewhere do not move it.
        let stray = (0..60_u8).map(|k| ellipsoid.centre + Vec3::new(30.0, f32::from(k), 0.0));
        let other = fit(&roots(places.into_iter().chain(stray))).expect("a scalp");
        assert!(
            other.ellipsoid.centre.distance(found.ellipsoid.centre) < 0.2,
            "{other} for {found}"
        );
    }
}

#[test]
fn a_strip_of_hair_stands_on_a_head_of_usual_proportions() {
    // A mohawk: roots near the middle plane show height and depth, not the width.
    let head = Ellipsoid {
        centre: Vec3::ZERO,
        radii: HEAD,
    };
    let strip = on(head, 20_000, 0.0, 0.0)
        .into_iter()
        .filter(|root| root.x.abs() < 0.8);
    let found = fit(&roots(strip)).expect("a scalp").ellipsoid;
    let off = (found.radii / HEAD - 0.995).abs().max_element();
    assert!(off < 0.1 && found.centre.length() < 1.0, "{found:?}");
}

#[test]
fn what_is_no_scalp_is_refused() {
    let few = fit(&roots((0..9_u8).map(|k| f32::from(k) * Vec3::X))).expect_err("too few");
    assert_eq!(few, "--scalp auto must have at least 10 strands, got 9");
    let mut xi = Independent::new(4, 0);
    let cloud = (0..500)
        .map(|_| Vec3::from(xi.next_xi_f32::<3>()))
        .collect::<Vec<_>>();
    let plane = cloud
        .iter()
        .map(|p| Vec3::new(p.x, 0.0, p.z))
        .collect::<Vec<_>>();
    // A mane: from the forehead down a back, 70 cm long.
    let mane = (0..500_u16)
        .map(|k| {
            let along = f32::from(k) / 500.0;
            let across = f32::from(k % 7) - 3.0;
            Vec3::new(across, 70.0 - 70.0 * along, 12.0 * (3.0 * along).sin())
        })
        .collect::<Vec<_>>();
    let one = vec![Vec3::ONE; 20];
    for (places, what) in [
        (cloud, "median distance"),
        (plane, "plane"),
        (mane, "small part"),
        (one, "one place"),
    ] {
        let problem = fit(&roots(places)).expect_err(what);
        assert!(
            problem.contains(what) && problem.contains("--head"),
            "{problem}"
        );
    }
}
