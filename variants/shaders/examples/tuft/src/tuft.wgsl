// Path tracer over a tuft of straight hairs, to follow the generated source of the Gaussian model with its matched sampler.

struct Hair {
    root: vec4<f32>,
    tangent: vec4<f32>,
}

@group(0) @binding(0) var<storage, read> hairs: array<Hair>;
@group(0) @binding(1) var<storage, read> material: HairisGaussianMatchedMaterial;
@group(0) @binding(2) var<storage, read_write> picture: array<vec4<f32>>;

const SIDE = 160u;
const SAMPLES = 32u;
const BOUNCES = 6u;
const RADIUS = 0.012;
const SUN = vec3<f32>(0.5076731, 0.6092077, 0.6092077);
const SUNLIGHT = 5.0;

var<private> state: u32;

// Draws a number in [0, 1) from a permuted congruential generator.
fn unit() -> f32 {
    state = state * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

fn three() -> vec3<f32> {
    let x = unit();
    let y = unit();
    return vec3<f32>(x, y, unit());
}

fn across(v: vec3<f32>, tangent: vec3<f32>) -> vec3<f32> {
    return v - dot(v, tangent) * tangent;
}

struct Meeting {
    distance: f32,
    tangent: vec3<f32>,
    normal: vec3<f32>,
}

// Returns the nearest hair along a ray; a distance below 0 means that the ray meets no hair.
fn meet(origin: vec3<f32>, ray: vec3<f32>) -> Meeting {
    var nearest = Meeting(-1.0, vec3<f32>(), vec3<f32>());
    for (var i = 0u; i < arrayLength(&hairs); i++) {
        let tangent = hairs[i].tangent.xyz;
        let offset = origin - hairs[i].root.xyz;
        let d = across(ray, tangent);
        let o = across(offset, tangent);
        let a = dot(d, d);
        let b = dot(d, o);
        let c = dot(o, o) - RADIUS * RADIUS;
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 || c <= 0.0 {
            continue;
        }
        let t = (-b - sqrt(discriminant)) / a;
        let along = dot(offset + t * ray, tangent);
        if t > 0.0 && along >= 0.0 && along < 1.0 && (nearest.distance < 0.0 || t < nearest.distance) {
            nearest = Meeting(t, tangent, normalize(across(o + t * d, tangent)));
        }
    }
    return nearest;
}

fn sky(ray: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(0.3, 0.4, 0.6) * (0.6 + 0.4 * ray.y);
}

// Adds one sample to each pixel, whose fourth number counts them.
@compute @workgroup_size(64)
fn draw(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = id.x;
    if pixel >= SIDE * SIDE {
        return;
    }
    let sample = u32(picture[pixel].w);
    state = (pixel * SAMPLES + sample) * 9781u + 1u;
    let hair = material;
    let x = (f32(pixel % SIDE) + unit()) / f32(SIDE) - 0.5;
    let y = (f32(pixel / SIDE) + unit()) / f32(SIDE) - 0.5;
    var origin = vec3<f32>(0.0, 0.8, 4.0);
    var ray = normalize(vec3<f32>(0.5 * x, -0.5 * y - 0.08, -1.0));
    var light = vec3<f32>();
    var throughput = vec3<f32>(1.0);
    for (var bounce = 0u; bounce < BOUNCES; bounce++) {
        let hit = meet(origin, ray);
        if hit.distance < 0.0 {
            light += throughput * sky(ray);
            break;
        }
        origin += hit.distance * ray + 1e-4 * hit.normal;
        // Frame of the fibre: u along it, v the normal.
        let w = cross(hit.tangent, hit.normal);
        let to_local = transpose(mat3x3<f32>(hit.tangent, hit.normal, w));
        let wo = to_local * -ray;
        let wi = to_local * SUN;
        let h = wo.z / max(length(wo.yz), 1e-20);
        let both = hairis_gaussian_matched_eval_sample_hit(hair, wo, h, wi, three());
        if meet(origin, SUN).distance < 0.0 {
            light += throughput * both.eval_value * length(wi.yz) * SUNLIGHT;
        }
        if both.sample_slot < 0.0 {
            break; // discarded: the path carries no light
        }
        throughput *= both.sample_weight;
        ray = both.sample_wi.x * hit.tangent + both.sample_wi.y * hit.normal + both.sample_wi.z * w;
    }
    picture[pixel] += vec4<f32>(light, 1.0);
}
