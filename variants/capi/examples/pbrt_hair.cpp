// A hair BxDF in the style of pbrt-v4, in one file:
//   c++ -std=c++17 pbrt_hair.cpp $(pkg-config --cflags --libs hairis) && ./a.out
//
// pbrt's shading frame of a curve is (x along it, y, z the normal), and so is the fibre's, with u = x. pbrt's integrators multiply f
// by the cosine to the normal, which is not the fibre's: f is S cos(theta_i) / |wi.z|, as in pbrt's own HairBxDF.
#include <hairis.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

struct Vector3f { float x, y, z; };
struct Point2f { float x, y; };
struct RGB { float r, g, b; };
struct BSDFSample { RGB f; Vector3f wi; float pdf; };

/// pbrt makes one per hit, and calls it with one wo: the hit is prepared once.
class HairBxDF {
 public:
  /// On a round curve, whose normal is z, the offset across the fibre is u . (z x wo) / cos(theta_o); on a flat one it is 2 v - 1 of
  /// the curve's parameter v.
  HairBxDF(const hairis::Material &material, Vector3f wo)
      : bsdf_(material.prepare({wo.x, wo.y, wo.z}, std::hypot(wo.y, wo.z) > 0 ? -wo.y / std::hypot(wo.y, wo.z) : 0)) {}
  HairBxDF(const hairis::Material &material, Vector3f wo, float h) : bsdf_(material.prepare({wo.x, wo.y, wo.z}, h)) {}

  RGB f(Vector3f wi) const { return scaled(bsdf_.eval_pdf({wi.x, wi.y, wi.z}).value, wi); }
  float PDF(Vector3f wi) const { return bsdf_.eval_pdf({wi.x, wi.y, wi.z}).pdf; }
  std::optional<BSDFSample> Sample_f(float uc, Point2f u) const {
    auto sample = bsdf_.sample(uc, u.x, u.y);
    if (!sample) return {};
    Vector3f wi{sample->wi[0], sample->wi[1], sample->wi[2]};
    return BSDFSample{scaled(sample->value, wi), wi, sample->pdf};
  }
  const hairis::Bsdf &bsdf() const { return bsdf_; }

 private:
  static RGB scaled(const float value[3], Vector3f wi) {
    float by = wi.z != 0 ? std::hypot(wi.y, wi.z) / std::fabs(wi.z) : 0;
    return {value[0] * by, value[1] * by, value[2] * by};
  }
  hairis::Bsdf bsdf_;
};

/// A furnace against albedo(), and densities of samples against PDF.
int main() {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  const Vector3f wo{0.5f, 0.3f, std::sqrt(1 - 0.25f - 0.09f)};
  const int n = 100000;
  int bad = 0;
  for (const hairis::Model &model : hairis::Model::all()) {
    const hairis_model_info &info = model.info;
    hairis::Material material(hairis::Params(info.name, info.word[0] ? info.word : nullptr, "brown"));
    HairBxDF hair(material, wo);
    double sum = 0, worst = 0;
    for (int i = 0; i < n; ++i) {
      auto sample = hair.Sample_f(uniform(rng), {uniform(rng), uniform(rng)});
      if (!sample) continue;
      sum += double(sample->f.r) * std::fabs(sample->wi.z) / sample->pdf;
      worst = std::max(worst, std::fabs(double(hair.PDF(sample->wi)) / sample->pdf - 1));
    }
    double albedo = hair.bsdf().albedo()[0];
    bool ok = std::fabs(sum / n / albedo - 1) < 0.02 && worst < 1e-2;
    bad += !ok;
    std::printf("%-10s %-10s furnace %.5f, albedo %.5f, worst density of a sample off by %.1e%s\n", info.name, info.word, sum / n,
                albedo, worst, ok ? "" : "  BAD");
  }
  try {
    hairis::Material(hairis::Params("gaussian", "matched").set("beta", {0.1f, 0, 0.2f}));
    ++bad;
  } catch (const hairis::Error &error) {
    bool ok = error.code() == HAIRIS_VALUE && error.number() == 1 && error.field() == std::string("beta");
    bad += !ok;
    std::printf("refused, as it must be: %s\n", error.what());
  }
  return bad;
}
