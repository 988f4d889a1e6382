// Chiang et al. 2016, with the longitudinal term of d'Eon et al. 2011.
#include "port.cuh"

struct PortMaterial {
    TYPE_OF_PARAMS p;
    float variance[4], sin_shift[4], cos_shift[4];
    // Of the logistic: its scale, and its mass below -pi and within [-pi, pi].
    float scale, below, within;
};
struct PortPrepared {
    const PortMaterial &m;
    float phi_o, sin_cone[4], cos_cone[4], centre[4], probability[4];
    HairisVec3 attenuation[4];
};

static inline PortMaterial port_material(const TYPE_OF_PARAMS &p) {
    PortMaterial m;
    m.p = p;
    const float n = p.beta_n, k = p.beta_m, tilt = p.tilt;
    const float root = 0.726f * k + 0.812f * k * k + 3.7f * powf(k, 20.0f), v = root * root;
    const float shift[4] = {-2.0f * tilt, (p.shifts == 0.0f ? 1.0f : 2.0f * p.eta - 2.0f) * tilt,
        (p.shifts == 0.0f ? 4.0f : 4.0f * p.eta - 2.0f) * tilt, 0.0f};
    const float variance[4] = {v, v / 4.0f, 4.0f * v, 4.0f * v};
    for (int lobe = 0; lobe < 4; lobe++) {
        m.variance[lobe] = variance[lobe];
        m.sin_shift[lobe] = sinf(shift[lobe]);
        m.cos_shift[lobe] = cosf(shift[lobe]);
    }
    m.scale = sqrtf(PI / 8.0f) * (0.265f * n + 1.194f * n * n + 5.372f * powf(n, 22.0f));
    const float tail = expf(-PI / m.scale);
    m.below = tail / (1.0f + tail);
    m.within = tanhf(PI / (2.0f * m.scale));
    return m;
}

PORT float fresnel(float eta, float cos) {
    const float inner = sqrtf((eta - 1.0f) * (eta + 1.0f) + cos * cos);
    const float perpendicular = (cos - inner) / (cos + inner);
    const float parallel = (eta * eta * cos - inner) / (eta * eta * cos + inner);
    return 0.5f * (perpendicular * perpendicular + parallel * parallel);
}

PORT PortPrepared port_prepare(const PortMaterial &m, HairisVec3 wo, float h) {
    PortPrepared point = {m};
    const TYPE_OF_PARAMS &p = m.p;
    const float sin_o = wo.x, cos_o = sqrtf(wo.y * wo.y + wo.z * wo.z);
    point.phi_o = atan2f(wo.z, wo.y);
    for (int lobe = 0; lobe < 4; lobe++) {
        point.sin_cone[lobe] = sin_o * m.cos_shift[lobe] - cos_o * m.sin_shift[lobe];
        point.cos_cone[lobe] = fabsf(cos_o * m.cos_shift[lobe] + sin_o * m.sin_shift[lobe]);
    }
    const float root = sqrtf((p.eta - 1.0f) * (p.eta + 1.0f) + cos_o * cos_o);
    const float sin_gamma_t = clamped(h * cos_o / root, -1.0f, 1.0f), cos_gamma_t = sqrtf(1.0f - sin_gamma_t * sin_gamma_t);
    const float gamma_o = asinf(h), gamma_t = asinf(sin_gamma_t);
    for (int lobe = 0; lobe < 4; lobe++) point.centre[lobe] = 2.0f * lobe * gamma_t - 2.0f * gamma_o + lobe * PI;
    const float length = 2.0f * p.eta * cos_gamma_t / root, f = fresnel(p.eta, cos_o * sqrtf(1.0f - h * h));
    const HairisVec3 t = hairis_vec3(expf(-p.sigma_a[0] * length), expf(-p.sigma_a[1] * length), expf(-p.sigma_a[2] * length));
    const HairisVec3 tt = scaled(t, (1.0f - f) * (1.0f - f));
    const HairisVec3 trt = hairis_vec3(tt.x * f * t.x, tt.y * f * t.y, tt.z * f * t.z);
    point.attenuation[0] = hairis_vec3(f, f, f);
    point.attenuation[1] = tt;
    point.attenuation[2] = trt;
    point.attenuation[3] =
        hairis_vec3(trt.x * f * t.x / (1.0f - f * t.x), trt.y * f * t.y / (1.0f - f * t.y), trt.z * f * t.z / (1.0f - f * t.z));
    float all = 0.0f;
    for (int lobe = 0; lobe < 4; lobe++) {
        const HairisVec3 a = point.attenuation[lobe];
        all += point.probability[lobe] = a.x + a.y + a.z;
    }
    for (int lobe = 0; lobe < 4; lobe++) point.probability[lobe] /= all;
    return point;
}

// exp(-x) I0(x), by polynomials fitted to 2e-7.
PORT float bessel_i0_scaled(float x) {
    if (x < 5.5f) {
        const float y = x * x;
        float sum = 3.643167776e-12f;
        sum = sum * y + 4.1442875935e-10f;
        sum = sum * y + 6.908044545e-8f;
        sum = sum * y + 6.7667667005e-6f;
        sum = sum * y + 4.3411848311e-4f;
        sum = sum * y + 0.015624746521f;
        sum = sum * y + 0.25000024714f;
        return expf(-x) * (sum * y + 0.99999996493f);
    }
    const float y = 1.0f / x;
    float sum = 0.5356207298f;
    sum = sum * y - 0.05543233086f;
    sum = sum * y + 0.03746055819f;
    sum = sum * y + 0.02780520842f;
    sum = sum * y + 0.04986873773f;
    return (sum * y + 0.39894230081f) / sqrtf(x);
}

PORT float longitudinal(float v, float sin_cone, float cos_cone, float sin_i, float cos_i) {
    const float x = cos_i - cos_cone, y = sin_i + sin_cone;
    return expf(-(x * x + y * y) / (2.0f * v)) * bessel_i0_scaled(cos_i * cos_cone / v) / (v * (1.0f - expf(-2.0f / v)));
}

PORT float logistic(const PortMaterial &m, float x) {
    const float e = expf(-fabsf(x) / m.scale), sum = 1.0f + e;
    return e / (m.scale * sum * sum * m.within);
}

PORT PortEval at_angles(const PortPrepared &point, float sin_i, float cos_i, float phi) {
    PortEval e = {};
    for (int lobe = 0; lobe < 4; lobe++) {
        float x = phi - point.centre[lobe];
        x -= 2.0f * PI * rintf(x / (2.0f * PI));
        const float azimuthal = lobe == 3 ? 0.5f / PI : logistic(point.m, x);
        const float pdf =
            longitudinal(point.m.variance[lobe], point.sin_cone[lobe], point.cos_cone[lobe], sin_i, cos_i) * azimuthal;
        e.value = add(e.value, scaled(point.attenuation[lobe], pdf / cos_i));
        e.pdf += point.probability[lobe] * pdf;
    }
    return e;
}

PORT PortEval port_eval(const PortPrepared &point, HairisVec3 wi) {
    const float cos_i = sqrtf(wi.y * wi.y + wi.z * wi.z);
    return cos_i < 1e-5f ? PortEval() : at_angles(point, wi.x, cos_i, atan2f(wi.z, wi.y) - point.phi_o);
}

PORT PortSample port_sample(const PortPrepared &point, HairisVec3 xi) {
    float rest, sine, cosine;
    const PortMaterial &m = point.m;
    const int lobe = choose(point.probability, xi.x, &rest);
    float v = m.variance[3], sin_cone = point.sin_cone[3], cos_cone = point.cos_cone[3], centre = point.centre[3];
    for (int k = 0; k < 3; k++)
        if (k == lobe) v = m.variance[k], sin_cone = point.sin_cone[k], cos_cone = point.cos_cone[k], centre = point.centre[k];
    const float delta = fminf(-v * logf(1.0f - xi.y * (1.0f - expf(-2.0f / v))), 2.0f);
    const float along = 1.0f - delta, across = sqrtf(delta * (2.0f - delta));
    sincosf(PI * xi.z, &sine, &cosine);
    const float sin_i = across * cosine * cos_cone - along * sin_cone;
    const float cos_i = hypotf(along * cos_cone + across * cosine * sin_cone, across * sine);
    if (cos_i < 1e-5f) return discarded();
    const float odds = (m.below + rest * m.within) / (m.below + (1.0f - rest) * m.within);
    const float x = lobe == 3 ? PI * (2.0f * rest - 1.0f) : clamped(m.scale * logf(odds), -PI, PI), phi = centre + x;
    return finish(lobe, sin_i, cos_i, point.phi_o + phi, at_angles(point, sin_i, cos_i, phi));
}

PORT_HITS
