// What the ports of the papers' formulas share: angles, and the calls of a hit. Each port is what a renderer would have without this
// project: the formulas as printed, constants of a material formed once, functions of CUDA's library.

#define PORT static __host__ __device__ __forceinline__

struct PortEval {
    HairisVec3 value;
    float pdf;
};
struct PortSample {
    HairisVec3 wi, value;
    float pdf;
    HairisVec3 weight;
    float slot;
};
struct PortEvalSample {
    PortEval eval;
    PortSample sample;
};

static const float PI = 3.14159265f;

PORT HairisVec3 scaled(HairisVec3 a, float by) { return hairis_vec3(a.x * by, a.y * by, a.z * by); }
PORT HairisVec3 rgb(const float *c) { return hairis_vec3(c[0], c[1], c[2]); }
PORT HairisVec3 add(HairisVec3 a, HairisVec3 b) { return hairis_vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
PORT float mean(const float *c) { return (c[0] + c[1] + c[2]) / 3.0f; }
PORT float clamped(float x, float lo, float hi) { return fminf(fmaxf(x, lo), hi); }

// An angle within a turn and a half brought to [-pi, pi].
PORT float wrapped(float phi) { return phi > PI ? phi - 2.0f * PI : phi < -PI ? phi + 2.0f * PI : phi; }

// The first lobe whose cumulative probability exceeds `xi`, and how far into its share `xi` is.
template <int COUNT> PORT int choose(const float (&probability)[COUNT], float xi, float *rest) {
    float sum = probability[0], below = 0.0f, share = probability[0];
    int lobe = 0;
#pragma unroll
    for (int k = 1; k < COUNT; k++) {
        if (xi >= sum) {
            lobe = k;
            below = sum;
            share = probability[k];
        }
        sum += probability[k];
    }
    *rest = clamped((xi - below) / share, 0.0f, 0x1.fffffep-1f);
    return lobe;
}

PORT PortSample discarded() {
    PortSample s = {};
    s.slot = -1.0f;
    return s;
}

PORT PortSample finish(int lobe, float sin_theta_i, float cos_theta_i, float phi_i, PortEval at) {
    if (cos_theta_i < 1e-5f || !(at.pdf > 0.0f)) return discarded();
    PortSample s;
    float sine, cosine;
    sincosf(phi_i, &sine, &cosine);
    s.wi = hairis_vec3(sin_theta_i, cos_theta_i * cosine, cos_theta_i * sine);
    s.value = at.value;
    s.pdf = at.pdf;
    s.weight = scaled(at.value, cos_theta_i / at.pdf);
    s.slot = (float)lobe;
    return s;
}

// The port's struct of a material is before this macro, with `port_material`, `port_prepare`, `port_eval` and `port_sample`.
#define PORT_HITS                                                                                  \
    PORT PortEval port_eval_hit(const PortMaterial &m, HairisVec3 wo, float h, HairisVec3 wi) {    \
        return port_eval(port_prepare(m, wo, h), wi);                                              \
    }                                                                                              \
    PORT PortSample port_sample_hit(const PortMaterial &m, HairisVec3 wo, float h, HairisVec3 xi) { \
        return port_sample(port_prepare(m, wo, h), xi);                                            \
    }                                                                                              \
    PORT PortEvalSample port_eval_sample_hit(                                                      \
        const PortMaterial &m, HairisVec3 wo, float h, HairisVec3 wi, HairisVec3 xi) {             \
        const PortPrepared point = port_prepare(m, wo, h);                                         \
        return {port_eval(point, wi), port_sample(point, xi)};                                     \
    }
