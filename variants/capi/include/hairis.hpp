// hairis for C++17: materials and BSDFs as value types over hairis.h.
//
// Set-up throws hairis::Error; calls per hit and per direction are noexcept. Copies are memcpy, and nothing needs to be destroyed.
#ifndef HAIRIS_HPP
#define HAIRIS_HPP

#include "hairis.h"

#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hairis {

/// Error of set-up: what() is a sentence, and the other members say what is at fault.
class Error : public std::runtime_error {
 public:
  explicit Error(const hairis_error &error) : std::runtime_error(error.message), error_(error) {}
  hairis_status code() const noexcept { return error_.code; }
  const char *field() const noexcept { return error_.field; }
  /// Place of the number at fault in its field, or -1 for the whole field.
  int number() const noexcept { return error_.number; }
  float value() const noexcept { return error_.value; }

 private:
  hairis_error error_;
};

enum class Energy : uint32_t {
  Raw = HAIRIS_ENERGY_RAW,
  Conserving = HAIRIS_ENERGY_CONSERVING,
  Scaled = HAIRIS_ENERGY_SCALED,
};

/// Model of the library with its fields and presets, as a host's interface presents it.
struct Model {
  hairis_model_info info{};
  std::vector<hairis_field_info> fields;
  std::vector<std::string> presets;

  static std::vector<Model> all() {
    std::vector<Model> models(hairis_model_count());
    for (uint32_t m = 0; m < models.size(); ++m) models[m] = at(m);
    return models;
  }
  static Model at(uint32_t index) {
    Model model;
    if (hairis_model_describe(index, &model.info) != HAIRIS_OK) throw std::out_of_range("hairis: no model of this index");
    model.fields.resize(model.info.fields);
    for (uint32_t f = 0; f < model.info.fields; ++f) hairis_field_describe(index, f, &model.fields[f]);
    for (uint32_t p = 0; p < model.info.presets; ++p) {
      std::string name(hairis_preset_name(index, p, nullptr, 0) + 1, '\0');
      name.resize(hairis_preset_name(index, p, &name[0], name.size()));
      model.presets.push_back(name);
    }
    return model;
  }
};

/// Values of a model's fields, by name.
class Params {
 public:
  /// Makes parameters of a model. choice is the word of the sampler, or of the model's other choice, and preset is a name; both may be
  /// nullptr.
  explicit Params(const char *model, const char *choice = nullptr, const char *preset = nullptr) {
    if (hairis_abi_version() != HAIRIS_ABI_VERSION) {
      throw std::runtime_error("hairis: the library has interface " + std::to_string(hairis_abi_version()) +
                               ", the header " + std::to_string(HAIRIS_ABI_VERSION));
    }
    hairis_error error{};
    check(hairis_params_init(&params_, model, choice, preset, &error), error);
  }
  Params &set(const char *field, std::initializer_list<float> numbers) {
    return set(field, numbers.begin(), numbers.size());
  }
  Params &set(const char *field, float number) { return set(field, &number, 1); }
  Params &set(const char *field, const float *numbers, size_t count) {
    hairis_error error{};
    check(hairis_params_set(&params_, field, numbers, count, &error), error);
    return *this;
  }
  Params &set(const char *field, const char *word) {
    hairis_error error{};
    check(hairis_params_set_word(&params_, field, word, &error), error);
    return *this;
  }
  Params &set(const hairis_artist &controls) {
    hairis_error error{};
    check(hairis_params_set_artist(&params_, &controls, &error), error);
    return *this;
  }
  Model model() const { return Model::at(params_.model); }
  const hairis_params &get() const noexcept { return params_; }

  static void check(hairis_status status, const hairis_error &error) {
    if (status != HAIRIS_OK) throw Error(error);
  }

 private:
  hairis_params params_{};
};

/// Material at a hit. A default-constructed BSDF scatters nothing.
class Bsdf {
 public:
  Bsdf() = default;
  Bsdf(const hairis_material &material, std::array<float, 3> wo, float h = 0) noexcept {
    hairis_prepare(&bsdf_, &material, wo[0], wo[1], wo[2], h);
  }
  /// Returns the value without the cosine, and the density.
  hairis_eval_result eval_pdf(std::array<float, 3> wi) const noexcept {
    return hairis_eval_pdf(&bsdf_, wi[0], wi[1], wi[2]);
  }
  /// Draws a sample. Returns nothing for a discarded sample, which still counts, with a contribution of 0.
  std::optional<hairis_sample_result> sample(float xi_lobe, float xi_theta, float xi_phi) const noexcept {
    hairis_sample_result s = hairis_sample(&bsdf_, xi_lobe, xi_theta, xi_phi);
    if (s.lobe < 0) return std::nullopt;
    return s;
  }
  std::array<hairis_lobe_result, 4> lobes(std::array<float, 3> wi) const noexcept {
    std::array<hairis_lobe_result, 4> to;
    hairis_lobes(&bsdf_, wi[0], wi[1], wi[2], to.data());
    return to;
  }
  /// Returns the directional albedo of all lobes together.
  std::array<float, 3> albedo() const noexcept {
    float lobes[4][3];
    hairis_albedo(&bsdf_, lobes);
    std::array<float, 3> sum{};
    for (auto &lobe : lobes) {
      for (size_t c = 0; c < 3; ++c) sum[c] += lobe[c];
    }
    return sum;
  }
  /// Keeps lobe i if bit i is set; the other lobes neither scatter nor are sampled.
  Bsdf with_lobes(uint32_t lobes) const noexcept {
    Bsdf kept = *this;
    hairis_restrict(&kept.bsdf_, lobes);
    return kept;
  }
  const hairis_bsdf &get() const noexcept { return bsdf_; }

 private:
  hairis_bsdf bsdf_{};
};

/// Model with checked parameters. A default-constructed material scatters nothing.
class Material {
 public:
  Material() = default;
  explicit Material(const Params &params, Energy energy = Energy::Conserving) {
    hairis_error error{};
    Params::check(hairis_material_init(&material_, &params.get(), static_cast<uint32_t>(energy), &error), error);
  }
  Bsdf prepare(std::array<float, 3> wo, float h = 0) const noexcept { return Bsdf(material_, wo, h); }
  float max_albedo() const noexcept { return hairis_material_max_albedo(&material_); }
  const hairis_material &get() const noexcept { return material_; }

 private:
  hairis_material material_{};
};

}  // namespace hairis
#endif
