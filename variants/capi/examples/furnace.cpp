// A furnace in C++: light of radiance 1 from everywhere on blond hair of every model, drawn to furnace.ppm. Two stripes per model, raw above
// conserving; across, the fibre turns against the view from one grazing end to the other. A pixel is the mean weight of samples: what
// is darker than white was absorbed, and what is magenta returns more light than arrives.
//   c++ -std=c++17 furnace.cpp $(pkg-config --cflags --libs hairis) && ./a.out
#include <hairis.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <vector>

constexpr int WIDTH = 320, STRIPE = 12, SAMPLES = 64;

using Rgb = std::array<float, 3>;

/// Mean over so many samples, of which discarded ones are black.
static Rgb furnace(const hairis::Bsdf &bsdf, std::mt19937 &numbers) {
  std::uniform_real_distribution<float> xi(0.0f, 1.0f - 0x1p-24f);
  Rgb sum{};
  for (int i = 0; i < SAMPLES; ++i) {
    float lobe = xi(numbers), theta = xi(numbers), phi = xi(numbers);
    if (auto sample = bsdf.sample(lobe, theta, phi)) {
      for (int c = 0; c < 3; ++c) sum[c] += sample->weight[c] / SAMPLES;
    }
  }
  return sum;
}

int main() try {
  std::mt19937 numbers(1);
  std::vector<unsigned char> pixels;
  double worst = 0;
  for (uint32_t m = 0; m < hairis_model_count(); ++m) {
    hairis::Model model = hairis::Model::at(m);
    for (hairis::Energy energy : {hairis::Energy::Raw, hairis::Energy::Conserving}) {
      hairis::Params params(model.info.name, model.info.word[0] ? model.info.word : nullptr, "blond");
      hairis::Material hair(params, energy);
      double drawn = 0, albedo = 0;
      for (int y = 0; y < STRIPE; ++y) {
        for (int x = 0; x < WIDTH; ++x) {
          float theta = 3.14159265f * ((x + 0.5f) / WIDTH - 0.5f), h = 2 * (y + 0.5f) / STRIPE - 1;
          hairis::Bsdf bsdf = hair.prepare({std::sin(theta), std::cos(theta), 0}, h);
          Rgb rgb = furnace(bsdf, numbers);
          drawn += rgb[0], albedo += bsdf.albedo()[0];
          if (bsdf.albedo()[0] > 1.01f) rgb = {1, 0, 1};
          // The sRGB curve, nearly.
          for (float light : rgb) pixels.push_back(static_cast<unsigned char>(255 * std::pow(std::min(light, 1.0f), 1 / 2.2f) + 0.5f));
        }
      }
      std::printf("%-11s %-10s %-10s furnace %.4f, albedo %.4f\n", model.info.name, model.info.word,
                  energy == hairis::Energy::Raw ? "raw" : "conserving", drawn / (WIDTH * STRIPE), albedo / (WIDTH * STRIPE));
      worst = std::max(worst, std::abs(drawn / albedo - 1));
    }
  }
  std::ofstream("furnace.ppm", std::ios::binary)
      << "P6 " << WIDTH << " " << pixels.size() / (3 * WIDTH) << " 255\n" << std::string(pixels.begin(), pixels.end());
  std::printf("furnace.ppm: means are the albedo within %.2f%%\n", 100 * worst);
  return worst < 0.01 ? 0 : 1;
} catch (const std::exception &error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
