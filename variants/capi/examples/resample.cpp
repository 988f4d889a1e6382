// One ray for sixteen candidates: direct light of a smooth sky at one hit, by resampling and by one BSDF sample.
//   c++ -std=c++17 resample.cpp $(pkg-config --cflags --libs hairis) && ./a.out
// Both estimate the same light; the variance of one resampled ray is a tenth.
#include <hairis.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

namespace {
constexpr uint32_t kBsdf = 8, kLight = 8, kAll = kBsdf + kLight;
constexpr float kPi = 3.14159265f, kPdfLight = 1 / (4 * kPi);

std::array<float, 3> sky(float u, float, float w) {
  float up = 0.5f + 0.5f * w;
  return {4 * up * up, up, up * (1 - u * u)};
}

/// Mean and squared deviation over mean squared.
struct Estimate {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) { sum += x, squares += x * x, ++count; }
  double mean() const { return sum / count; }
  double relative_variance() const { return squares / count / (mean() * mean()) - 1; }
  double error() const { return mean() * std::sqrt(relative_variance() / count); }
};
}  // namespace

int main() {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  hairis::Material hair(hairis::Params("gaussian", "matched", "brown"));
  hairis::Bsdf bsdf = hair.prepare({0.6f, 0.8f, 0});
  Estimate resampled, single;
  for (int round = 0; round < 20000; ++round) {
    float xi[3][kAll], wi[3][kAll], radiance[3][kAll], pdf_light[kAll], contribution[3][kAll], weight[kAll];
    for (auto &column : xi) {
      for (float &x : column) x = uniform(rng);
    }
    // Propose: the BSDF's candidates, and those of the light, here uniform over the sphere.
    const float *numbers[3] = {xi[0], xi[1], xi[2]};
    hairis_samples directions{{wi[0], wi[1], wi[2]}, {}, nullptr, {}, nullptr};
    if (hairis_sample_columns(&bsdf.get(), kBsdf, numbers, &directions) != HAIRIS_OK) return 2;
    for (uint32_t i = kBsdf; i < kAll; ++i) {
      float sin = 2 * xi[0][i] - 1, cos = std::sqrt(1 - sin * sin), phi = 2 * kPi * xi[1][i];
      wi[0][i] = sin, wi[1][i] = cos * std::cos(phi), wi[2][i] = cos * std::sin(phi);
    }
    // Look up, weigh, choose.
    for (uint32_t i = 0; i < kAll; ++i) {
      auto light = sky(wi[0][i], wi[1][i], wi[2][i]);
      for (int c = 0; c < 3; ++c) radiance[c][i] = light[c];
      pdf_light[i] = kPdfLight;
    }
    hairis_candidates candidates{{wi[0], wi[1], wi[2]}, {radiance[0], radiance[1], radiance[2]}, pdf_light};
    hairis_weights weights{{contribution[0], contribution[1], contribution[2]}, weight};
    if (hairis_weigh_columns(&bsdf.get(), kAll, &candidates, {kBsdf, kLight, HAIRIS_PARTITION_ALL}, &weights) != HAIRIS_OK) return 2;
    hairis_choice choice;
    double light = 0;
    if (hairis_choose(&weights, kAll, 1, uniform(rng), &choice) == 1) {
      for (float c : choice.contribution) light += c;
    }
    resampled.add(light);

    double one = 0;
    if (auto sample = bsdf.sample(uniform(rng), uniform(rng), uniform(rng))) {
      auto from = sky(sample->wi[0], sample->wi[1], sample->wi[2]);
      for (int c = 0; c < 3; ++c) one += from[c] * sample->weight[c];
    }
    single.add(one);
  }
  std::printf("one of %u candidates: %.4f +- %.4f, variance %.3f of the squared mean\n", unsigned(kAll), resampled.mean(),
              resampled.error(), resampled.relative_variance());
  std::printf("one BSDF sample:      %.4f +- %.4f, variance %.3f\n", single.mean(), single.error(), single.relative_variance());
  double apart = std::fabs(resampled.mean() - single.mean()) / std::hypot(resampled.error(), single.error());
  return !(apart < 3 && resampled.relative_variance() < 0.2 * single.relative_variance());
}
