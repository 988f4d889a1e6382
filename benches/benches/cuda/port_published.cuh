// Ou et al. 2012, sections 3.1 to 3.3 and appendices A to D. With PORT_CAUCHY, bells are Cauchy's.
#include "port.cuh"

// A Cauchy density cut to [lo, hi].
struct Cut {
    float location, scale, lo, hi, atan_lo, span;
};
PORT Cut cut(float location, float scale, float lo, float hi) {
    const float atan_lo = atanf((lo - location) / scale);
    return {location, scale, lo, hi, atan_lo, atanf((hi - location) / scale) - atan_lo};
}
PORT float cut_pdf(const Cut &c, float x) {
    const float d = x - c.location;
    return x < c.lo || x > c.hi ? 0.0f : c.scale / (c.span * (d * d + c.scale * c.scale));
}
PORT float cut_sample(const Cut &c, float xi) {
    return clamped(c.scale * tanf(xi * c.span + c.atan_lo) + c.location, c.lo, c.hi);
}

PORT float bell(float width, float x) {
#ifdef PORT_CAUCHY
    return width * width / (x * x + width * width);
#else
    return expf(-x * x / (2.0f * width * width));
#endif
}

struct PortMaterial {
    TYPE_OF_PARAMS p;
    Cut tt, glint;
    float probability[4];
};
struct PortPrepared {
    const PortMaterial &m;
    float theta_o, phi_o;
    Cut theta[3];
};

PORT PortMaterial port_material(const TYPE_OF_PARAMS &p) {
    PortMaterial m;
    m.p = p;
    m.tt = cut(PI, p.gamma_tt, 0.0f, 2.0f * PI);
    m.glint = cut(p.phi_g, p.gamma_g, 0.0f, 0.5f * PI);
    const float cosine = 4.0f * sqrtf(2.0f * PI);
    const float energy[4] = {cosine * p.beta[0] * mean(p.i_r), 2.0f * PI * p.beta[1] * p.gamma_tt * mean(p.i_tt),
        cosine * p.beta[2] * mean(p.i_trt), 4.0f * PI * p.beta[2] * p.gamma_g * mean(p.i_trt) * p.i_g};
    const float all = energy[0] + energy[1] + energy[2] + energy[3];
    for (int k = 0; k < 4; k++) m.probability[k] = energy[k] / all;
    return m;
}

PORT PortPrepared port_prepare(const PortMaterial &m, HairisVec3 wo, float) {
    const float theta_o = asinf(clamped(wo.x, -1.0f, 1.0f));
    const float lo = 0.5f * (theta_o - 0.5f * PI), hi = 0.5f * (theta_o + 0.5f * PI);
    return {m, theta_o, atan2f(wo.z, wo.y),
        {cut(m.p.alpha[0], m.p.beta[0], lo, hi), cut(m.p.alpha[1], m.p.beta[1], lo, hi),
            cut(m.p.alpha[2], m.p.beta[2], lo, hi)}};
}

PORT PortEval at_angles(const PortPrepared &point, float theta_i, float cos_theta_i, float phi) {
    const TYPE_OF_PARAMS &p = point.m.p;
    const float theta_h = 0.5f * (theta_i + point.theta_o), theta_d = 0.5f * (point.theta_o - theta_i);
    const float cos_theta_d = cosf(theta_d), cos_half_phi = fmaxf(cosf(0.5f * phi), 0.0f), across = fabsf(phi);
    const float per = 1.0f / (cos_theta_d * cos_theta_d);
    const float m_trt = bell(p.beta[2], theta_h - p.alpha[2]);
    const float r = bell(p.beta[0], theta_h - p.alpha[0]) * cos_half_phi * per;
    const float tt = bell(p.beta[1], theta_h - p.alpha[1]) * bell(p.gamma_tt, PI - across) * per;
    const float trt = m_trt * (cos_half_phi + p.i_g * bell(p.gamma_g, across - p.phi_g)) * per;
    PortEval e;
    e.value = add(add(scaled(rgb(p.i_r), r), scaled(rgb(p.i_tt), tt)), scaled(rgb(p.i_trt), trt));
    const float *probability = point.m.probability;
    const float quarter = 0.25f * cos_half_phi;
    const float theta_trt = cut_pdf(point.theta[2], theta_h);
    const float pdf = probability[0] * cut_pdf(point.theta[0], theta_h) * quarter +
        probability[1] * cut_pdf(point.theta[1], theta_h) * cut_pdf(point.m.tt, across) + probability[2] * theta_trt * quarter +
        probability[3] * theta_trt * 0.5f * cut_pdf(point.m.glint, across);
    e.pdf = 0.5f * pdf / cos_theta_i;
    return e;
}

PORT PortEval port_eval(const PortPrepared &point, HairisVec3 wi) {
    const float cos_theta_i = sqrtf(wi.y * wi.y + wi.z * wi.z);
    if (cos_theta_i < 1e-5f) return PortEval();
    return at_angles(point, asinf(clamped(wi.x, -1.0f, 1.0f)), cos_theta_i, wrapped(point.phi_o - atan2f(wi.z, wi.y)));
}

PORT PortSample port_sample(const PortPrepared &point, HairisVec3 xi) {
    float rest, phi;
    const int lobe = choose(point.m.probability, xi.x, &rest);
    const float theta_i = 2.0f * cut_sample(lobe == 0 ? point.theta[0] : lobe == 1 ? point.theta[1] : point.theta[2], xi.y) -
        point.theta_o;
    if (lobe == 1)
        phi = cut_sample(point.m.tt, xi.z);
    else if (lobe == 3)
        phi = xi.z < 0.5f ? cut_sample(point.m.glint, 2.0f * xi.z) : -cut_sample(point.m.glint, 2.0f - 2.0f * xi.z);
    else
        phi = 2.0f * asinf(clamped(2.0f * xi.z - 1.0f, -1.0f, 1.0f));
    float sine, cosine;
    sincosf(theta_i, &sine, &cosine);
    phi = wrapped(phi);
    return finish(lobe, sine, cosine, point.phi_o - phi, at_angles(point, theta_i, cosine, phi));
}

PORT_HITS
