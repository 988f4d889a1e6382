// Kajiya & Kay 1989, the reciprocal form, normalised, with our sampler.
#include "port.cuh"

struct PortMaterial {
    TYPE_OF_PARAMS p;
    // Integrals of cos^(p + 2) and cos^p, means of the colours, share of the highlight that a grazing view returns.
    float norm, norm_pdf, diffuse, specular, grazing;
};
struct PortPrepared {
    const PortMaterial &m;
    float sin_theta_o, cos_theta_o, probability[2];
};

static inline float cosine_power_integral(double n) { return (float)(sqrt(M_PI) * exp(lgamma(0.5 * n + 0.5) - lgamma(0.5 * n + 1.0))); }

static inline PortMaterial port_material(const TYPE_OF_PARAMS &p) {
    return {p, cosine_power_integral(p.exponent + 2.0), cosine_power_integral(p.exponent), mean(p.kd), mean(p.ks),
        1.0f / (p.exponent + 1.0f)};
}

PORT PortPrepared port_prepare(const PortMaterial &m, HairisVec3 wo, float) {
    const float sine = wo.x, cosine = sqrtf(wo.y * wo.y + wo.z * wo.z);
    const float specular = m.specular * (cosine * cosine + sine * sine * m.grazing), all = m.diffuse + specular;
    return {m, sine, cosine, {m.diffuse / all, specular / all}};
}

PORT float positive_sq(float x) { return x > 0.0f ? x * x : 0.0f; }

PORT PortEval at_inclination(const PortPrepared &point, float sin_theta_i, float cos_theta_i) {
    const TYPE_OF_PARAMS &p = point.m.p;
    const float sin_o = point.sin_theta_o, cos_o = point.cos_theta_o;
    const float cos_sum = cos_theta_i * cos_o - sin_theta_i * sin_o;
    const float cos_mirrored = cos_sum * cos_o - (sin_theta_i * cos_o + cos_theta_i * sin_o) * sin_o;
    const float highlight = powf(fmaxf(cos_sum, 0.0f), p.exponent);
    PortEval e;
    e.value = add(scaled(rgb(p.kd), 1.0f / (PI * PI)), scaled(rgb(p.ks), highlight / (2.0f * PI * point.m.norm)));
    e.pdf = point.probability[0] * cos_theta_i / (PI * PI) +
        point.probability[1] * highlight * cos_theta_i /
            (PI * point.m.norm_pdf * (cos_theta_i * cos_theta_i + positive_sq(cos_mirrored)));
    return e;
}

PORT PortEval port_eval(const PortPrepared &point, HairisVec3 wi) {
    const float cos_theta_i = sqrtf(wi.y * wi.y + wi.z * wi.z);
    return cos_theta_i < 1e-5f ? PortEval() : at_inclination(point, wi.x, cos_theta_i);
}

// Sine and cosine of the angle at a squared radius of the disk.
PORT void from_disk(float radius_sq, float xi_turn, float *sin_x, float *cos_x) {
    float sine, cosine;
    sincosf(PI * xi_turn, &sine, &cosine);
    *sin_x = sqrtf(radius_sq) * cosine;
    *cos_x = fminf(sqrtf(1.0f - radius_sq + radius_sq * sine * sine), 1.0f);
}

PORT PortSample port_sample(const PortPrepared &point, HairisVec3 xi) {
    float rest, sin_i, cos_i, xi_phi = xi.z;
    const int lobe = choose(point.probability, xi.x, &rest);
    if (lobe == 0) {
        from_disk(xi.y, rest, &sin_i, &cos_i);
    } else {
        float sin_x, cos_x;
        const float sin_o = point.sin_theta_o, cos_o = point.cos_theta_o;
        from_disk(1.0f - powf(1.0f - xi.y, 2.0f / point.m.p.exponent), rest, &sin_x, &cos_x);
        const float kept = positive_sq(cos_x * cos_o + sin_x * sin_o), turned = positive_sq(cos_x * cos_o - sin_x * sin_o);
        const float share = kept + turned > 0.0f ? kept / (kept + turned) : 1.0f;
        if (xi.z < share) {
            xi_phi = xi.z / share;
        } else {
            xi_phi = (xi.z - share) / (1.0f - share);
            sin_x = -sin_x;
        }
        sin_i = sin_x * cos_o - cos_x * sin_o;
        cos_i = fmaxf(cos_x * cos_o + sin_x * sin_o, 0.0f);
    }
    return finish(lobe, sin_i, cos_i, PI * (2.0f * xi_phi - 1.0f), at_inclination(point, sin_i, cos_i));
}

PORT_HITS
