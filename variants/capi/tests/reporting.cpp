// What the C++ header reports without exceptions, compiled with and without them.
#include <hairis.hpp>

#include <cstdio>
#include <cstring>

static int failed, checked;

static void want(bool condition, const char *what) {
  ++checked;
  if (!condition) ++failed, std::fprintf(stderr, "FAIL %s\n", what);
}

static bool says(const hairis_error &error, hairis_status code, const char *field, const char *words) {
  return error.code == code && std::strcmp(error.field, field) == 0 && std::strstr(error.message, words);
}

static bool is_empty(const hairis::Material &material) {
  static const hairis_material empty{};
  return std::memcmp(&material.get(), &empty, sizeof empty) == 0;
}

int main() {
  using hairis::Energy;
  // A material in one go, and a check behind it.
  hairis_error error{};
  hairis::Params params("gaussian", "matched", "brown", error);
  const float alpha[] = {-0.1f, 0.05f, 0.15f};
  params.set("beta", {0.1f, 0.05f, 0.2f}, error).set("i_g", 2.0f, error).set("alpha", alpha, 3, error);
  hairis::Material material(params, Energy::Scaled, error);
  want(error.code == HAIRIS_OK && material.prepare({0.6f, 0.8f, 0}).eval_pdf({0, 1, 0}).pdf > 0, "a material");
  hairis_artist artist;
  hairis_artist_init(&artist);
  params.set(artist, error);
  want(error.code == HAIRIS_OK && params.model(error).info.name == std::string("gaussian"), "an artist's hair");
  hairis::Params chiang("chiang", nullptr, nullptr, error);
  chiang.set("shifts", "small-angle", error);
  want(error.code == HAIRIS_OK && hairis::Model::all().size() == hairis_model_count(), "models");

  hairis::Params cycles = hairis::Params::like("cycles", error).set("roughness", 0.2f, error);
  hairis::Material like(cycles, Energy::Raw, error);
  want(error.code == HAIRIS_OK && like.prepare({0.6f, 0.8f, 0}).eval_pdf({0, 1, 0}).pdf > 0, "another renderer's parameters");
  want(cycles.model(error).fields.at(0).name == std::string("roughness"), "its fields");

  cycles.set_color({0.5f, 0.3f, 0.2f}, "fibre", error);
  want(error.code == HAIRIS_OK && cycles.model(error).fields.at(0).name == std::string("beta_m"), "a colour, of chiang's own parameters");

  // The first error stays, whatever follows.
  hairis::Params unknown("hair", nullptr, nullptr, error);
  want(says(error, HAIRIS_NAME, "model", "got \"hair\""), "a model that there is not");
  unknown.set("beta", 1.0f, error).set("shifts", "none", error).set(artist, error);
  hairis::Material none(unknown, Energy::Raw, error), other(params, Energy::Raw, error);
  hairis::Model model = hairis::Model::at(1000, error);
  want(says(error, HAIRIS_NAME, "model", "got \"hair\"") && model.fields.empty(), "the first error");
  want(is_empty(none) && is_empty(other) && none.prepare({0.6f, 0.8f, 0}).eval_pdf({0, 1, 0}).pdf == 0, "a refused material");

  const hairis_params before = params.get();
  auto refused = [&](auto call, hairis_status code, const char *field, const char *words) {
    error = {};
    call();
    want(says(error, code, field, words), words);
    want(std::memcmp(&before, &params.get(), sizeof before) == 0, "parameters change where a field is refused");
  };
  refused([&] { hairis::Material(unknown, Energy::Raw, error); }, HAIRIS_ARGUMENT, "params", "hairis_params_init");
  refused([&] { params.set("width", 1.0f, error); }, HAIRIS_NAME, "width", "field must be one of");
  refused([&] { params.set("beta", {1.0f}, error); }, HAIRIS_VALUE, "beta", "beta must be 3 numbers");
  refused([&] { params.set("beta", "wide", error); }, HAIRIS_VALUE, "beta", "use hairis_params_set");
  refused([&] { params.set("beta", nullptr, 3, error); }, HAIRIS_ARGUMENT, "numbers", "not NULL");
  refused([&] { chiang.set(artist, error); }, HAIRIS_ARGUMENT, "model", "gaussian or cauchy");
  refused([&] { hairis::Model::at(1000, error); }, HAIRIS_ARGUMENT, "index", "index must be below ");
  refused(
      [&] {
        hairis::Params wide("chiang", nullptr, nullptr, error);
        is_empty(hairis::Material(wide.set("beta_m", 9.0f, error), Energy::Raw, error));
      },
      HAIRIS_VALUE, "beta_m", "beta_m must be");

#if HAIRIS_THROWS
  // The constructors that throw say the same.
  auto thrown = [](auto call, const hairis_error &reported) {
    try {
      call();
    } catch (const hairis::Error &caught) {
      return caught.code() == reported.code && std::strcmp(caught.what(), reported.message) == 0;
    }
    return false;
  };
  error = {};
  hairis::Params("hair", nullptr, nullptr, error);
  want(thrown([] { hairis::Params("hair"); }, error), "a model that there is not, thrown");
  error = {};
  hairis::Material(unknown, Energy::Raw, error);
  want(thrown([&] { hairis::Material(unknown, Energy::Raw); }, error), "parameters of nothing, thrown");
  error = {};
  hairis::Model::at(1000, error);
  want(thrown([] { hairis::Model::at(1000); }, error), "an index, thrown");
  error = {};
  params.set("width", 1.0f, error);
  want(thrown([&] { params.set("width", 1.0f); }, error), "a field, thrown");
#endif
  std::printf("%d reports %s exceptions, %d failed\n", checked, HAIRIS_THROWS ? "with" : "without", failed);
  return failed != 0;
}
