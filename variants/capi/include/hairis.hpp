// hairis for C++17: materials and BSDFs as value types over hairis.h.
//
// Set-up throws hairis::Error, or reports to a hairis_error that is passed last and throws nothing. That error begins as {}, and calls do
// nothing once it has a code, so that one check behind several calls finds the first error. Without exceptions (-fno-exceptions) only the
// calls that report are declared. Calls per hit and per direction are noexcept. Copies are memcpy, and nothing needs to be destroyed.
#ifndef HAIRIS_HPP
#define HAIRIS_HPP

#include "hairis.h"

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define HAIRIS_THROWS 1
#else
#define HAIRIS_THROWS 0
#endif

#include <array>
#include <cstddef>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>
#if HAIRIS_THROWS
#include <stdexcept>
#endif

namespace hairis {

#if HAIRIS_THROWS
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
#endif

enum class Energy : uint32_t {
  Raw = HAIRIS_ENERGY_RAW,
  Conserving = HAIRIS_ENERGY_CONSERVING,
  Scaled = HAIRIS_ENERGY_SCALED,
};

namespace detail {
/// Runs set-up that reports to an error, unless that has a code already.
template <class Call>
void report(hairis_error &error, Call call) noexcept {
  if (error.code == HAIRIS_OK) call(&error);
}
#if HAIRIS_THROWS
/// Runs set-up that reports to an error, and throws what it reports.
template <class Call>
void check(Call call) {
  hairis_error error{};
  call(error);
  if (error.code != HAIRIS_OK) throw Error(error);
}
#endif
}  // namespace detail

/// Model of the library with its fields and presets, as a host's interface presents it.
struct Model {
  hairis_model_info info{};
  std::vector<hairis_field_info> fields;
  std::vector<std::string> presets;

  static std::vector<Model> all() {
    std::vector<Model> models(hairis_model_count());
    hairis_error error{};
    for (uint32_t m = 0; m < models.size(); ++m) models[m] = at(m, error);
    return models;
  }
  /// Returns the model of an index, or reports that there is none.
  static Model at(uint32_t index, hairis_error &error) {
    Model model;
    if (error.code != HAIRIS_OK) return model;
    if (hairis_model_describe(index, &model.info) != HAIRIS_OK) {
      error = hairis_error{HAIRIS_ARGUMENT, -1, 0, "index", ""};
      std::snprintf(error.message, sizeof error.message, "index must be below %u, the count of models, got %u",
                    static_cast<unsigned>(hairis_model_count()), static_cast<unsigned>(index));
      return model;
    }
    model.fields.resize(model.info.fields);
    for (uint32_t f = 0; f < model.info.fields; ++f) hairis_field_describe(index, f, &model.fields[f]);
    for (uint32_t p = 0; p < model.info.presets; ++p) {
      std::string name(hairis_preset_name(index, p, nullptr, 0) + 1, '\0');
      name.resize(hairis_preset_name(index, p, &name[0], name.size()));
      model.presets.push_back(name);
    }
    return model;
  }
#if HAIRIS_THROWS
  static Model at(uint32_t index) {
    Model model;
    detail::check([&](hairis_error &error) { model = at(index, error); });
    return model;
  }
#endif
};

/// Values of a model's fields, by name.
class Params {
 public:
  /// Makes parameters of a model. choice is the word of the sampler, or of the model's other choice, and preset is a name; both may be
  /// nullptr. Parameters that are refused are empty, and no material is made of them.
  Params(const char *model, const char *choice, const char *preset, hairis_error &error) noexcept {
    detail::report(error, [&](hairis_error *to) {
      if (hairis_abi_version() == HAIRIS_ABI_VERSION) {
        hairis_params_init(&params_, model, choice, preset, to);
        return;
      }
      *to = hairis_error{HAIRIS_ARGUMENT, -1, 0, "", ""};
      std::snprintf(to->message, sizeof to->message, "hairis: the library has interface %u, the header %u",
                    static_cast<unsigned>(hairis_abi_version()), static_cast<unsigned>(HAIRIS_ABI_VERSION));
    });
  }
  /// Makes parameters of chiang in the terms of another renderer, whose names `set` then takes: see hairis_params_like.
  static Params like(const char *renderer, hairis_error &error) noexcept {
    Params params;
    detail::report(error, [&](hairis_error *to) { hairis_params_like(&params.params_, renderer, to); });
    return params;
  }
  Params &set(const char *field, std::initializer_list<float> numbers, hairis_error &error) noexcept {
    return set(field, numbers.begin(), numbers.size(), error);
  }
  Params &set(const char *field, float number, hairis_error &error) noexcept { return set(field, &number, 1, error); }
  Params &set(const char *field, const float *numbers, size_t count, hairis_error &error) noexcept {
    detail::report(error, [&](hairis_error *to) { hairis_params_set(&params_, field, numbers, count, to); });
    return *this;
  }
  Params &set(const char *field, const char *word, hairis_error &error) noexcept {
    detail::report(error, [&](hairis_error *to) { hairis_params_set_word(&params_, field, word, to); });
    return *this;
  }
  Params &set(const hairis_artist &controls, hairis_error &error) noexcept {
    detail::report(error, [&](hairis_error *to) { hairis_params_set_artist(&params_, &controls, to); });
    return *this;
  }
  /// Sets what decides the colour of the hair: see hairis_params_set_color.
  Params &set_color(const float (&color)[3], const char *of, hairis_error &error) noexcept {
    detail::report(error, [&](hairis_error *to) { hairis_params_set_color(&params_, color, of, to); });
    return *this;
  }
#if HAIRIS_THROWS
  explicit Params(const char *model, const char *choice = nullptr, const char *preset = nullptr) {
    detail::check([&](hairis_error &error) { *this = Params(model, choice, preset, error); });
  }
  static Params like(const char *renderer) {
    Params params;
    detail::check([&](hairis_error &error) { params = like(renderer, error); });
    return params;
  }
  Params &set(const char *field, std::initializer_list<float> numbers) {
    return set(field, numbers.begin(), numbers.size());
  }
  Params &set(const char *field, float number) { return set(field, &number, 1); }
  Params &set(const char *field, const float *numbers, size_t count) {
    detail::check([&](hairis_error &error) { set(field, numbers, count, error); });
    return *this;
  }
  Params &set(const char *field, const char *word) {
    detail::check([&](hairis_error &error) { set(field, word, error); });
    return *this;
  }
  Params &set(const hairis_artist &controls) {
    detail::check([&](hairis_error &error) { set(controls, error); });
    return *this;
  }
  Params &set_color(const float (&color)[3], const char *of) {
    detail::check([&](hairis_error &error) { set_color(color, of, error); });
    return *this;
  }
  Model model() const { return Model::at(params_.model); }
#endif
  Model model(hairis_error &error) const { return Model::at(params_.model, error); }
  const hairis_params &get() const noexcept { return params_; }

 private:
  Params() = default;
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
  std::array<hairis_lobe_result, HAIRIS_LOBES> lobes(std::array<float, 3> wi) const noexcept {
    std::array<hairis_lobe_result, HAIRIS_LOBES> to;
    hairis_lobes(&bsdf_, wi[0], wi[1], wi[2], to.data());
    return to;
  }
  /// Returns the directional albedo of all lobes together.
  std::array<float, 3> albedo() const noexcept {
    float lobes[HAIRIS_LOBES][3];
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
  /// Makes a material, which stays empty if the parameters are refused.
  Material(const Params &params, Energy energy, hairis_error &error) noexcept {
    detail::report(error, [&](hairis_error *to) {
      hairis_material_init(&material_, &params.get(), static_cast<uint32_t>(energy), to);
    });
  }
#if HAIRIS_THROWS
  explicit Material(const Params &params, Energy energy = Energy::Conserving) {
    detail::check([&](hairis_error &error) { *this = Material(params, energy, error); });
  }
#endif
  Bsdf prepare(std::array<float, 3> wo, float h = 0) const noexcept { return Bsdf(material_, wo, h); }
  float max_albedo() const noexcept { return hairis_material_max_albedo(&material_); }
  const hairis_material &get() const noexcept { return material_; }

 private:
  hairis_material material_{};
};

}  // namespace hairis
#endif
