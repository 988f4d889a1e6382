// A Mitsuba 3 BSDF over hairis, for scalar_rgb: built against the headers of Mitsuba's wheel by build.sh.
//
// Mitsuba's frame of a curve is (x, y along it, z the normal); the fibre's (u, v, w) is (y, z, x). Mitsuba's eval includes the cosine
// to the normal plane.
#include <hairis.hpp>
#include <mitsuba/core/plugin.h>
#include <mitsuba/core/properties.h>
#include <mitsuba/render/bsdf.h>
#include <mitsuba/render/texture.h>

NAMESPACE_BEGIN(mitsuba)

template <typename Float, typename Spectrum> class HairIS final : public BSDF<Float, Spectrum> {
public:
    MI_IMPORT_BASE(BSDF, m_flags, m_components)
    MI_IMPORT_TYPES(Texture)

    HairIS(const Properties &props) : Base(props) {
        std::string model = props.get<std::string>("model", "gaussian"), choice = props.get<std::string>("choice", ""),
                    preset = props.get<std::string>("preset", ""), energy = props.get<std::string>("energy", "conserving");
        try {
            hairis::Params params(model.c_str(), choice.empty() ? nullptr : choice.c_str(),
                                  preset.empty() ? nullptr : preset.c_str());
            for (const hairis_field_info &field : params.model().fields) set(params, field, props);
            if (energy != "raw" && energy != "conserving" && energy != "scaled")
                Throw("hairis: energy must be raw, conserving or scaled, got \"%s\"", energy);
            m_material = hairis::Material(params, energy == "raw" ? hairis::Energy::Raw
                                                  : energy == "scaled" ? hairis::Energy::Scaled : hairis::Energy::Conserving);
        } catch (const hairis::Error &error) {
            Throw("hairis: %s", error.what());
        }
        m_components.push_back(BSDFFlags::Glossy | BSDFFlags::Anisotropic | BSDFFlags::NonSymmetric | BSDFFlags::FrontSide);
        m_components.push_back(BSDFFlags::Null | BSDFFlags::BackSide);
        m_flags = m_components[0] | m_components[1];
    }

    std::pair<BSDFSample3f, Spectrum> sample(const BSDFContext &ctx, const SurfaceInteraction3f &si, Float s1,
                                             const Point2f &s2, Mask active) const override {
        if (!active || !ctx.is_enabled(BSDFFlags::Glossy)) return { dr::zeros<BSDFSample3f>(), 0.f };
        return draw(prepare(si.wi), s1, s2);
    }
    Spectrum eval(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Mask active) const override {
        return eval_pdf(ctx, si, wo, active).first;
    }
    Float pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo, Mask active) const override {
        return eval_pdf(ctx, si, wo, active).second;
    }
    std::pair<Spectrum, Float> eval_pdf(const BSDFContext &ctx, const SurfaceInteraction3f &si, const Vector3f &wo,
                                        Mask active) const override {
        if (!active || !ctx.is_enabled(BSDFFlags::Glossy)) return { 0.f, 0.f };
        return value(prepare(si.wi), wo);
    }
    /// One hit serves the light's direction and the next.
    std::tuple<Spectrum, Float, BSDFSample3f, Spectrum> eval_pdf_sample(const BSDFContext &ctx, const SurfaceInteraction3f &si,
                                                                        const Vector3f &wo, Float s1, const Point2f &s2,
                                                                        Mask active) const override {
        if (!active || !ctx.is_enabled(BSDFFlags::Glossy)) return { 0.f, 0.f, dr::zeros<BSDFSample3f>(), 0.f };
        hairis::Bsdf bsdf = prepare(si.wi);
        auto [spectrum, density] = value(bsdf, wo);
        auto [bs, weight] = draw(bsdf, s1, s2);
        return { spectrum, density, bs, weight };
    }
    std::string to_string() const override { return "HairIS[]"; }
    MI_DECLARE_CLASS(HairIS)

private:
    /// A field from the scene: a word, a colour, a number, or numbers in a string.
    static void set(hairis::Params &params, const hairis_field_info &field, const Properties &props) {
        if (!props.has_property(field.name)) return;
        if (field.kind == HAIRIS_KIND_WORD) {
            params.set(field.name, props.get<std::string>(field.name).c_str());
        } else if (field.kind == HAIRIS_KIND_RGB) {
            auto rgb = props.get<ScalarColor3f>(field.name);
            params.set(field.name, { rgb[0], rgb[1], rgb[2] });
        } else if (field.kind == HAIRIS_KIND_NUMBER) {
            params.set(field.name, props.get<ScalarFloat>(field.name));
        } else {
            std::vector<float> numbers;
            for (const std::string &token : string::tokenize(props.get<std::string>(field.name), " ,"))
                numbers.push_back(std::stof(token));
            params.set(field.name, numbers.data(), numbers.size());
        }
    }
    static float cosine(const Vector3f &w) { return std::sqrt(w.z() * w.z() + w.x() * w.x()); }
    /// On a round curve, whose normal is z, the offset across the fibre is x / cos(theta).
    hairis::Bsdf prepare(const Vector3f &w) const {
        float across = cosine(w);
        return m_material.prepare({ w.y(), w.z(), w.x() }, across > 0 ? w.x() / across : 0.f);
    }
    std::pair<BSDFSample3f, Spectrum> draw(const hairis::Bsdf &bsdf, Float s1, const Point2f &s2) const {
        BSDFSample3f bs = dr::zeros<BSDFSample3f>();
        bs.eta = 1.f;
        bs.sampled_type = +BSDFFlags::Glossy;
        auto sample = bsdf.sample(s1, s2.x(), s2.y());
        if (!sample) return { bs, 0.f };
        bs.wo = Vector3f(sample->wi[2], sample->wi[0], sample->wi[1]);
        bs.pdf = sample->pdf;
        return { bs, Spectrum(sample->weight[0], sample->weight[1], sample->weight[2]) };
    }
    std::pair<Spectrum, Float> value(const hairis::Bsdf &bsdf, const Vector3f &w) const {
        hairis_eval_result eval = bsdf.eval_pdf({ w.y(), w.z(), w.x() });
        return { Spectrum(eval.value[0], eval.value[1], eval.value[2]) * cosine(w), eval.pdf };
    }
    hairis::Material m_material;
};

extern "C" MI_EXPORT void init_plugin(std::string_view name, PluginRegisterFn cb) {
    using Plugin = HairIS<float, Color<float, 3>>;
    cb(name, "scalar_rgb", Plugin::Type, [](void *, const Properties &props) -> ref<Object> { return new Plugin(props); });
}
NAMESPACE_END(mitsuba)
