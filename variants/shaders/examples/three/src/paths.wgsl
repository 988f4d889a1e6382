// Path tracer over strands of hair, to follow the generated source of a model; CALL and MATERIAL stand for its names. Rays meet hair as those
// of hairis-render do: a hair is a ribbon that faces the ray, and a ray that leaves a strand does not meet it again within 1.5 radii.

struct Scene {
  eye: vec3f,
  sample: u32,
  right: vec3f, // from the middle of the picture to its side
  side: u32, // pixels along each side
  up: vec3f,
  columns: u32, // of the map
  forward: vec3f,
  rows: u32,
  backdrop: vec3f, // what the camera sees beside the hair, in place of the map
}

struct Box {
  low: vec3f,
  index: u32,
  high: vec3f,
  count: u32,
}

struct Texel {
  radiance: vec3f,
  share: f32, // of the light, up to and with this texel
}

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var<storage, read> nodes: array<vec4f>;
@group(0) @binding(2) var<storage, read> tangents: array<vec4f>;
@group(0) @binding(3) var<storage, read> segments: array<vec2u>;
@group(0) @binding(4) var<storage, read> boxes: array<Box>;
@group(0) @binding(5) var<storage, read> map: array<Texel>;
@group(0) @binding(6) var<storage, read> material: MATERIAL;
@group(0) @binding(7) var<storage, read> factors: array<vec4f>; // that conserve energy, by inclination
@group(0) @binding(8) var<storage, read_write> picture: array<vec4f>;

const PI = 3.14159265;
const MOST_BOUNCES = 1000u;
const FIRST_ROULETTE = 3u;
const NONE = 0xffffffffu;

var<private> state: u32;

// Draws a number in [0, 1) from a permuted congruential generator.
fn unit() -> f32 {
  state = state * 747796405u + 2891336453u;
  let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

fn three() -> vec3f {
  let x = unit();
  let y = unit();
  return vec3f(x, y, unit());
}

struct Ray {
  origin: vec3f,
  direction: vec3f,
  strand: u32, // whose hits do not count ...
  before: f32, // ... below this distance
}

struct Meeting {
  distance: f32, // below 0: the ray meets nothing
  segment: u32,
  place: f32,
}

// Distance to a box, or 1e30 where the ray misses it or meets it beyond `limit`.
fn enter(box: Box, origin: vec3f, inverse: vec3f, limit: f32) -> f32 {
  let a = (box.low - origin) * inverse;
  let b = (box.high - origin) * inverse;
  let near = min(a, b);
  let far = max(a, b);
  let first = max(max(near.x, near.y), max(near.z, 0.0));
  // Some units in the last place wider, because the products round.
  let last = min(min(far.x, far.y), min(far.z, limit)) * 1.000001;
  return select(1e30, first, first <= last);
}

// Meets the segment whose axis the ray passes within its radius: the nearest, or any with `isAny`.
fn meet(ray: Ray, isAny: bool) -> Meeting {
  var nearest = Meeting(-1.0, NONE, 0.0);
  var limit = 1e30;
  let direction = ray.direction;
  let inverse = 1.0 / select(direction, vec3f(1e-18), abs(direction) < vec3f(1e-18));
  var stack: array<u32, 40>;
  var top = 0u;
  var at = 0u;
  if enter(boxes[0], ray.origin, inverse, limit) >= 1e30 {
    return nearest;
  }
  loop {
    let box = boxes[at];
    if box.count > 0u {
      for (var i = box.index; i < box.index + box.count; i++) {
        let found = segments[i];
        let a = nodes[found.x];
        let b = nodes[found.x + 1u];
        let away = a.xyz - ray.origin;
        let edge = b.xyz - a.xyz;
        let fromAlong = dot(away, direction);
        let edgeAlong = dot(edge, direction);
        let start = away - fromAlong * direction;
        let across = edge - edgeAlong * direction;
        let s = clamp(-dot(start, across) / max(dot(across, across), 1e-30), 0.0, 1.0);
        let gap = start + s * across;
        let radius = a.w + s * (b.w - a.w);
        let t = fromAlong + s * edgeAlong;
        if dot(gap, gap) < radius * radius && t > 0.0 && t < limit && !(found.y == ray.strand && t < ray.before) {
          nearest = Meeting(t, i, s);
          limit = t;
          if isAny {
            return nearest;
          }
        }
      }
    } else {
      var first = box.index;
      var second = box.index + 1u;
      var near = enter(boxes[first], ray.origin, inverse, limit);
      var far = enter(boxes[second], ray.origin, inverse, limit);
      if far < near {
        first = box.index + 1u;
        second = box.index;
        let nearer = far;
        far = near;
        near = nearer;
      }
      if near < 1e30 {
        if far < 1e30 {
          stack[top] = second;
          top++;
        }
        at = first;
        continue;
      }
    }
    if top == 0u {
      break;
    }
    top--;
    at = stack[top];
  }
  return nearest;
}

fn texelOf(direction: vec3f) -> u32 {
  let polar = atan2(length(direction.xz), direction.y) / PI;
  let turn = 0.5 + atan2(direction.x, -direction.z) / (2.0 * PI);
  let row = min(u32(polar * f32(scene.rows)), scene.rows - 1u);
  let column = min(u32(max(turn, 0.0) * f32(scene.columns)), scene.columns - 1u);
  return row * scene.columns + column;
}

// Density of drawing a direction in a texel, per steradian.
fn density(texel: u32) -> f32 {
  let before = select(0.0, map[max(texel, 1u) - 1u].share, texel > 0u);
  let row = f32(texel / scene.columns);
  let area = 2.0 * PI / f32(scene.columns) * (cos(PI * row / f32(scene.rows)) - cos(PI * (row + 1.0) / f32(scene.rows)));
  return (map[texel].share - before) / area;
}

// Draws a texel by its light, and a direction in it.
fn drawLight(xi: vec3f) -> vec4f {
  var low = 0u;
  var high = scene.rows * scene.columns - 1u;
  while low < high {
    let middle = (low + high) / 2u;
    if map[middle].share > xi.x {
      high = middle;
    } else {
      low = middle + 1u;
    }
  }
  let row = f32(low / scene.columns);
  let y = mix(cos(PI * row / f32(scene.rows)), cos(PI * (row + 1.0) / f32(scene.rows)), xi.y);
  let turn = 2.0 * PI * ((f32(low % scene.columns) + xi.z) / f32(scene.columns) - 0.5);
  let r = sqrt(max(0.0, 1.0 - y * y));
  return vec4f(r * sin(turn), y, -r * cos(turn), density(low));
}

// Factor for a viewer at an inclination.
fn conserve(sine: f32) -> vec3f {
  let place = hairis_place(sine);
  let first = min(u32(place), arrayLength(&factors) - 2u);
  return mix(factors[first].xyz, factors[first + 1u].xyz, place - f32(first));
}

// Share of a sample where two ways of drawing find the same light.
fn shareOf(own: f32, other: f32) -> f32 {
  return own * own / (own * own + other * other);
}

// Adds one sample to each pixel, whose fourth number counts them.
@compute @workgroup_size(64)
fn draw(@builtin(global_invocation_id) id: vec3u) {
  let pixel = id.x;
  if pixel >= scene.side * scene.side {
    return;
  }
  state = (pixel * 747796405u) ^ (scene.sample * 2891336453u);
  state = u32(unit() * 16777216.0) * 9781u + scene.sample * 26699u + pixel;
  let hair = material;
  let x = 2.0 * (f32(pixel % scene.side) + unit()) / f32(scene.side) - 1.0;
  let y = 1.0 - 2.0 * (f32(pixel / scene.side) + unit()) / f32(scene.side);
  var ray = Ray(scene.eye, normalize(scene.forward + x * scene.right + y * scene.up), NONE, 0.0);
  var light = vec3f();
  var throughput = vec3f(1.0);
  var pdf = 0.0;
  for (var bounce = 0u; bounce < MOST_BOUNCES; bounce++) {
    let hit = meet(ray, false);
    if hit.distance < 0.0 {
      if bounce == 0u {
        light = scene.backdrop;
      } else {
        let texel = texelOf(ray.direction);
        light += throughput * map[texel].radiance * shareOf(pdf, density(texel));
      }
      break;
    }
    let segment = segments[hit.segment];
    let a = nodes[segment.x];
    let b = nodes[segment.x + 1u];
    let node = mix(a, b, hit.place);
    let h = clamp(dot(ray.origin - node.xyz, normalize(cross(b.xyz - a.xyz, ray.direction))) / node.w, -1.0, 1.0);
    // Frame of the hit: u along the fibre, v towards the viewer.
    let u = normalize(mix(tangents[segment.x].xyz, tangents[segment.x + 1u].xyz, hit.place));
    let sine = dot(-ray.direction, u);
    let v = normalize(-ray.direction - sine * u);
    let w = cross(u, v);
    let wo = vec3f(sine, dot(-ray.direction, v), 0.0);
    let lamp = drawLight(three());
    let wi = vec3f(dot(lamp.xyz, u), dot(lamp.xyz, v), dot(lamp.xyz, w));
    let factor = conserve(sine);
    let both = CALL(hair, wo, h, wi, three());
    let cosine = length(wi.yz);
    if lamp.w > 0.0 && max(both.eval_value.x, max(both.eval_value.y, both.eval_value.z)) > 0.0 {
      let shadow = Ray(node.xyz, lamp.xyz, segment.y, 1.5 * node.w / max(cosine, 0.01));
      if meet(shadow, true).distance < 0.0 {
        let radiance = map[texelOf(lamp.xyz)].radiance;
        light += throughput * factor * both.eval_value * cosine * radiance * shareOf(lamp.w, both.eval_pdf) / lamp.w;
      }
    }
    if both.sample_slot < 0.0 {
      break; // discarded: the path carries no light
    }
    throughput *= factor * both.sample_weight;
    pdf = both.sample_pdf;
    let local = both.sample_wi;
    ray = Ray(node.xyz, normalize(local.x * u + local.y * v + local.z * w), segment.y, 1.5 * node.w / max(length(local.yz), 0.01));
    let most = max(throughput.x, max(throughput.y, throughput.z));
    if most <= 0.0 {
      break;
    }
    if bounce + 1u >= FIRST_ROULETTE && most < 1.0 {
      if unit() >= most {
        break;
      }
      throughput /= most;
    }
  }
  picture[pixel] += vec4f(light, 1.0);
}
