/* What the library refuses: the status, the place, the sentence, and that nothing but the error is written. */
#include "hairis.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed, checked;

/* A buffer that must keep its bytes. */
static unsigned char guarded[16384];
static void fill(void) { memset(guarded, 0xa5, sizeof guarded); }
static int is_untouched(void) {
  for (size_t i = 0; i < sizeof guarded; ++i)
    if (guarded[i] != 0xa5) return 0;
  return 1;
}
static hairis_error error;

static void refused(hairis_status got, hairis_status code, const char *field, int number, const char *words) {
  ++checked;
  if (got == code && error.code == code && strcmp(error.field, field) == 0 && error.number == number &&
      strstr(error.message, words)) {
    memset(&error, 0x5a, sizeof error);
    return;
  }
  ++failed;
  fprintf(stderr, "FAIL status %d, wanted %d; field \"%.32s\", wanted \"%s\"; number %d; \"%.212s\", wanted \"%s\"\n", (int)got,
          (int)code, error.field, field, (int)error.number, error.message, words);
}
static void want(int condition, const char *what) {
  ++checked;
  if (!condition) ++failed, fprintf(stderr, "FAIL %s\n", what);
}

static void setup(void) {
  hairis_params *to = (hairis_params *)(void *)guarded, params, before;
  fill();
  refused(hairis_params_init(to, "hair", NULL, NULL, &error), HAIRIS_NAME, "model", -1,
          hairis_model_count() > 7 ? "gaussian-diffuse, cauchy-diffuse, chiang-diffuse, chiang-scattering, got \"hair\""
                                   : "model must be one of gaussian, cauchy, kajiya-kay, chiang, d-eon, got \"hair\"");
  refused(hairis_params_init(to, "\xff\xfe", NULL, NULL, &error), HAIRIS_NAME, "model", -1, "model must be one of");
  refused(hairis_params_init(to, "gaussian", "best", NULL, &error), HAIRIS_NAME, "sampler", -1, "sampler must be one of published, ");
  refused(hairis_params_init(to, "kajiya-kay", "best", NULL, &error), HAIRIS_NAME, "choice", -1, "choice must be NULL for kajiya-kay");
  refused(hairis_params_init(to, "chiang", NULL, "green", &error), HAIRIS_NAME, "preset", -1, "preset must be one of ");
  refused(hairis_params_init(to, NULL, NULL, NULL, &error), HAIRIS_ARGUMENT, "model", -1, "must not be NULL");
  refused(hairis_params_init(NULL, "chiang", NULL, NULL, &error), HAIRIS_ARGUMENT, "model", -1, "must not be NULL");
  want(hairis_params_init(to, "hair", NULL, NULL, NULL) == HAIRIS_NAME, "a refusal without an error to write");
  char longer[600];
  memset(longer, 'x', sizeof longer);
  longer[sizeof longer - 1] = 0;
  refused(hairis_params_init(to, longer, NULL, NULL, &error), HAIRIS_NAME, "model", -1, "got \"xxx");
  want(is_untouched(), "hairis_params_init writes what it refuses");

  if (hairis_params_init(&params, "chiang", NULL, NULL, &error)) want(0, "the default of chiang");
  before = params;
  const float numbers[56] = {0};
  refused(hairis_params_set(&params, "beta", numbers, 1, &error), HAIRIS_NAME, "beta", -1, "field must be one of beta_m, beta_n, ");
  refused(hairis_params_set(&params, NULL, numbers, 1, &error), HAIRIS_NAME, "", -1, "field must be one of ");
  refused(hairis_params_set(&params, "sigma_a", numbers, 2, &error), HAIRIS_VALUE, "sigma_a", -1, "sigma_a must be 3 numbers, got 2 numbers");
  refused(hairis_params_set(&params, "sigma_a", NULL, 3, &error), HAIRIS_ARGUMENT, "numbers", -1, "not NULL, got NULL");
  refused(hairis_params_set(&params, "sigma_a", numbers, 56, &error), HAIRIS_ARGUMENT, "numbers", -1, "at most 48 and not NULL, got 56");
  refused(hairis_params_set(&params, "shifts", numbers, 1, &error), HAIRIS_NAME, "shifts", -1,
          "shifts must be one of d-eon, small-angle, got 1 numbers");
  refused(hairis_params_set_word(&params, "shifts", "no\nne", &error), HAIRIS_NAME, "shifts", -1,
          "shifts must be one of d-eon, small-angle, got \"no\\nne\"");
  refused(hairis_params_set_word(&params, "eta", "glass", &error), HAIRIS_VALUE, "eta", -1,
          "eta must be numbers, got \"glass\": use hairis_params_set");
  refused(hairis_params_set_word(&params, "shifts", NULL, &error), HAIRIS_NAME, "shifts", -1, "one of");
  hairis_artist artist;
  hairis_artist_init(&artist);
  refused(hairis_params_set_artist(&params, &artist, &error), HAIRIS_ARGUMENT, "model", -1, "gaussian or cauchy");
  want(memcmp(&params, &before, sizeof params) == 0, "parameters change where a field is refused");

  if (hairis_params_init(&params, "gaussian", "matched", "brown", &error)) want(0, "a preset");
  before = params;
  artist.secondary.width_deg = 400;
  refused(hairis_params_set_artist(&params, &artist, &error), HAIRIS_VALUE, "secondary.width_deg", -1,
          "secondary.width_deg must be an angle in [0.01, 180] degrees, got 400");
  refused(hairis_params_set_artist(&params, NULL, &error), HAIRIS_ARGUMENT, "model", -1, "not NULL; got NULL");
  want(memcmp(&params, &before, sizeof params) == 0, "parameters change where an artist's control is refused");

  refused(hairis_params_like(&params, "blender", &error), HAIRIS_NAME, "renderer", -1,
          "renderer must be one of cycles, materialx, osl, pbrt, mitsuba, rtxcr, and to not NULL; got \"blender\"");
  refused(hairis_params_like(NULL, "cycles", &error), HAIRIS_NAME, "renderer", -1, "not NULL; got \"cycles\"");
  want(memcmp(&params, &before, sizeof params) == 0, "parameters change where a renderer is refused");
  const float color[3] = {0.5f, -1, 0.2f};
  refused(hairis_params_set_color(&params, color, "mass", &error), HAIRIS_VALUE, "color", 1, "color[1] must be finite and at least 0, got -1");
  refused(hairis_params_set_color(&params, NULL, "mass", &error), HAIRIS_ARGUMENT, "color", -1, "color must not be NULL");
  refused(hairis_params_set_color(&params, color, "head", &error), HAIRIS_NAME, "color_of", -1,
          "color_of must be one of chiang, fibre, mass, got \"head\"");
  refused(hairis_params_set_color(&params, color, "chiang", &error), HAIRIS_NAME, "color_of", -1,
          "color_of must be a sense that gaussian has, got \"chiang\"");
  refused(hairis_params_set_color(NULL, color, NULL, &error), HAIRIS_ARGUMENT, "params", -1, "hairis_params_init");
  want(memcmp(&params, &before, sizeof params) == 0, "parameters change where a colour is refused");
  if (hairis_params_like(&params, "cycles", &error)) want(0, "parameters of Cycles");
  refused(hairis_params_set(&params, "beta_m", numbers, 1, &error), HAIRIS_NAME, "beta_m", -1, "field must be one of roughness, ");
  const float rough = 1.5f, degrees = 2, melanin[1] = {1.3f}, tilt = -2 * 3.14159265358979f / 180, third = 0.3f;
  hairis_params_set(&params, "roughness", &rough, 1, &error);
  static hairis_material like, own;
  refused(hairis_material_init(&like, &params, HAIRIS_ENERGY_RAW, &error), HAIRIS_VALUE, "roughness", -1, "got 1.5");
  if (hairis_params_like(&params, "pbrt", &error) || hairis_params_set(&params, "alpha", &degrees, 1, &error) ||
      hairis_params_set(&params, "eumelanin", melanin, 1, &error) || hairis_material_init(&like, &params, HAIRIS_ENERGY_RAW, &error))
    want(0, "parameters of pbrt");
  hairis_field_info field;
  want(hairis_field_describe(params.model, 0, &field) == 0 && strcmp(field.name, "beta_m") == 0, "a field of pbrt");
  const float brown[2] = {1.3f, 0};
  if (hairis_params_init(&params, "chiang", NULL, NULL, &error) || hairis_params_set(&params, "beta_m", &third, 1, &error) ||
      hairis_params_set(&params, "beta_n", &third, 1, &error) || hairis_params_set(&params, "tilt", &tilt, 1, &error) ||
      hairis_params_set(&params, "melanin", brown, 2, &error) || hairis_material_init(&own, &params, HAIRIS_ENERGY_RAW, &error))
    want(0, "the same as chiang");
  hairis_bsdf of_like, of_own;
  hairis_prepare(&of_like, &like, 0.6f, 0.8f, 0, 0.4f), hairis_prepare(&of_own, &own, 0.6f, 0.8f, 0, 0.4f);
  const hairis_sample_result a = hairis_sample(&of_like, 0.3f, 0.6f, 0.2f), b = hairis_sample(&of_own, 0.3f, 0.6f, 0.2f);
  want(a.lobe >= 0 && a.pdf == b.pdf && memcmp(a.value, b.value, sizeof a.value) == 0 && memcmp(a.wi, b.wi, sizeof a.wi) == 0,
       "pbrt's parameters make another fibre");
  if (hairis_params_init(&params, "gaussian", "matched", "brown", &error)) want(0, "a preset");

  hairis_material *material = (hairis_material *)(void *)guarded;
  hairis_params none;
  memset(&none, 0, sizeof none);
  fill();
  refused(hairis_material_init(material, &none, HAIRIS_ENERGY_RAW, &error), HAIRIS_ARGUMENT, "params", -1, "hairis_params_init");
  none.model = 1000, none.given = 1;
  refused(hairis_material_init(material, &none, HAIRIS_ENERGY_RAW, &error), HAIRIS_ARGUMENT, "params", -1, "hairis_params_init");
  refused(hairis_material_init(material, NULL, HAIRIS_ENERGY_RAW, &error), HAIRIS_ARGUMENT, "params", -1, "hairis_params_init");
  refused(hairis_material_init(material, &params, 7, &error), HAIRIS_ARGUMENT, "energy", -1, "energy must be 0, 1 or 2, and to not NULL; got 7");
  refused(hairis_material_init(NULL, &params, 1, &error), HAIRIS_ARGUMENT, "energy", -1, "not NULL; got NULL");
  const float widths[3] = {0.1f, 0, 0.2f}, red[3] = {0, 1, -INFINITY};
  hairis_params_set(&params, "beta", widths, 3, &error);
  refused(hairis_material_init(material, &params, 1, &error), HAIRIS_VALUE, "beta", 1, "beta[1] must be a width in [1e-4, pi] rad, got 0");
  hairis_params_set(&before, "i_r", red, 3, &error);
  hairis_material_init(material, &before, 2, &error);
  want(isinf(error.value), "the value at fault");
  refused(HAIRIS_VALUE, HAIRIS_VALUE, "i_r", 2, "i_r[2] must be finite and at least 0, got -inf");
  want(is_untouched(), "hairis_material_init writes what it refuses");
  want(hairis_model_describe(1000, (hairis_model_info *)(void *)guarded) == HAIRIS_ARGUMENT, "a model that there is not");
  want(hairis_field_describe(0, 1000, (hairis_field_info *)(void *)guarded) == HAIRIS_ARGUMENT, "a field that there is not");
  want(hairis_preset_name(0, 1000, (char *)guarded, 9) == 0, "a preset that there is not");
  want(is_untouched(), "a description of nothing is written");
}

static void columns(void) {
  static hairis_material materials[3]; /* the last is empty, which is no error */
  hairis_params params;
  for (int m = 0; m < 2; ++m) {
    hairis_params_init(&params, m ? "chiang" : "gaussian", NULL, NULL, &error);
    hairis_material_init(&materials[m], &params, HAIRIS_ENERGY_CONSERVING, &error);
  }
  hairis_bsdf bsdf;
  hairis_prepare(&bsdf, &materials[0], 0.6f, 0.8f, 0, 0);
  enum { N = 40 };
  static float in[N];
  for (int i = 0; i < N; ++i) in[i] = 0.5f;
  uint32_t index[N] = {0};
  float *out = (float *)(void *)guarded;
  const float *wi[3] = {in, in, in}, *missing[3] = {in, NULL, in};
  hairis_evals evals = {{out, out + N, out + 2 * N}, out + 3 * N}, partial = {{out, NULL, NULL}, NULL};
  hairis_samples samples = {{out, out + N, out + 2 * N}, {NULL, NULL, NULL}, NULL, {NULL, NULL, NULL}, NULL};
  hairis_samples partial_samples = {{NULL, NULL, NULL}, {NULL, out, NULL}, NULL, {NULL, NULL, NULL}, NULL};
  hairis_hits hits = {{in, in, in}, NULL, index}, no_wo = {{in, in, NULL}, NULL, NULL};
  hairis_candidates candidates = {{in, in, in}, {in, in, in}, in}, no_light = {{in, in, in}, {in, in, in}, NULL};
  hairis_weights weights = {{out, out + N, out + 2 * N}, out + 3 * N}, no_weight = {{out, out + N, out + 2 * N}, NULL};
  hairis_counts counts = {1, 1, HAIRIS_PARTITION_ALL}, no_partition = {1, 1, 3};
  const size_t huge = (size_t)-1 / 2;
  fill();
#define REFUSED(call) want((call) == HAIRIS_ARGUMENT, #call)
  REFUSED(hairis_eval_columns(&bsdf, N, missing, &evals));
  REFUSED(hairis_eval_columns(&bsdf, N, NULL, &evals));
  REFUSED(hairis_eval_columns(&bsdf, N, wi, NULL));
  REFUSED(hairis_eval_columns(NULL, N, wi, &evals));
  REFUSED(hairis_eval_columns(&bsdf, huge, wi, &evals));
  REFUSED(hairis_sample_columns(&bsdf, N, missing, &samples));
  REFUSED(hairis_sample_columns(&bsdf, N, wi, NULL));
  REFUSED(hairis_sample_columns(NULL, N, wi, &samples));
  REFUSED(hairis_sample_columns(&bsdf, huge, wi, &samples));
  REFUSED(hairis_weigh_columns(&bsdf, N, &no_light, counts, &weights));
  REFUSED(hairis_weigh_columns(&bsdf, N, &candidates, no_partition, &weights));
  REFUSED(hairis_weigh_columns(&bsdf, N, &candidates, counts, &no_weight));
  REFUSED(hairis_weigh_columns(&bsdf, N, &candidates, counts, NULL));
  REFUSED(hairis_eval_hits(materials, 0, N, &hits, wi, &evals));
  REFUSED(hairis_eval_hits(NULL, 3, N, &hits, wi, &evals));
  REFUSED(hairis_eval_hits(materials, 3, N, NULL, wi, &evals));
  REFUSED(hairis_eval_hits(materials, 3, N, &hits, NULL, &evals));
  REFUSED(hairis_eval_hits(materials, 3, N, &hits, missing, &evals));
  REFUSED(hairis_eval_hits(materials, 3, N, &hits, wi, &partial));
  REFUSED(hairis_eval_hits(materials, 3, N, &no_wo, wi, &evals));
  REFUSED(hairis_eval_hits(materials, 3, huge, &hits, wi, &evals));
  REFUSED(hairis_sample_hits(materials, 3, N, &hits, wi, &partial_samples));
  REFUSED(hairis_sample_hits(materials, 3, N, &no_wo, wi, &samples));
  index[N - 1] = 3; /* behind the last material */
  REFUSED(hairis_eval_hits(materials, 3, N, &hits, wi, &evals));
  REFUSED(hairis_sample_hits(materials, 3, N, &hits, wi, &samples));
  want(is_untouched(), "columns that are refused are written");

  /* n = 0 succeeds whatever the pointers. */
  want(hairis_eval_columns(NULL, 0, NULL, NULL) == HAIRIS_OK && hairis_sample_columns(NULL, 0, NULL, NULL) == HAIRIS_OK &&
           hairis_weigh_columns(NULL, 0, NULL, counts, NULL) == HAIRIS_OK && hairis_choose(NULL, 0, 3, 0, NULL) == 0 &&
           hairis_eval_hits(NULL, 0, 0, NULL, NULL, NULL) == HAIRIS_OK && hairis_sample_hits(NULL, 0, 0, NULL, NULL, NULL) == HAIRIS_OK,
       "no rows");
}

/* Dual scattering of nothing: refused, or black. */
static void dual(void) {
  static hairis_material none;
  static hairis_dual averages;
  hairis_crossed clear = {1, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, after = clear;
  const float v[3] = {0, 1, 0}, gain[2] = {1, 1};
  float value[3] = {7, 7, 7};
  want(hairis_dual_init(NULL, &none) == HAIRIS_ARGUMENT && hairis_dual_init(&averages, NULL) == HAIRIS_ARGUMENT &&
           hairis_dual_init(&averages, &none) == HAIRIS_ARGUMENT,
       "averages of nothing");
  hairis_dual_through(NULL, &averages, 0);
  hairis_dual_through(&after, NULL, 0);
  want(after.direct == 0 && after.scattered[0] == 0 && hairis_dual_depth(NULL, 0, 0).direct == 1, "a fibre that scatters nothing");
  hairis_dual_shade(&averages, v, NULL, v, &clear, gain, value);
  hairis_dual_shade(&averages, v, v, v, &clear, gain, NULL);
  want(value[0] == 0 && value[2] == 0, "light from nowhere");
}

/* What a handle at this place gives in calls without a status: nothing. */
static void scatters_nothing(const hairis_material *material, hairis_bsdf *bsdf, const char *what) {
  hairis_eval_result eval = hairis_eval_pdf(bsdf, 0, 1, 0);
  hairis_sample_result sample = hairis_sample(bsdf, 0.5f, 0.5f, 0.5f);
  hairis_lobe_result lobes[HAIRIS_LOBES];
  float albedo[HAIRIS_LOBES][3];
  hairis_lobes(bsdf, 0, 1, 0, lobes);
  hairis_albedo(bsdf, albedo);
  hairis_restrict(bsdf, 1);
  want(eval.pdf == 0 && eval.value[0] == 0 && sample.lobe == -1 && sample.pdf == 0 && lobes[0].pdf == 0 && albedo[0][0] == 0 &&
           hairis_material_max_albedo(material) == 0,
       what);
}

/* An empty handle scatters nothing in any call, as one that is prepared does. */
static void empty(void) {
  enum { N = 700 };
  static hairis_material materials[3]; /* the second is empty */
  static hairis_bsdf none;
  static float in[N], h[N], out[11][N], whole[11][N];
  static uint32_t index[N];
  hairis_params params;
  for (int m = 0; m < 3; m += 2) {
    hairis_params_init(&params, m ? "chiang" : "gaussian", NULL, NULL, &error);
    hairis_material_init(&materials[m], &params, HAIRIS_ENERGY_CONSERVING, &error);
  }
  scatters_nothing(&materials[1], &none, "empty handles scatter nothing");
  memset(&none, 0xa5, sizeof none);
  hairis_prepare(&none, &materials[1], 0.6f, 0.8f, 0, 0);
  scatters_nothing(&materials[1], &none, "a BSDF of an empty material scatters nothing");
  for (int i = 0; i < N; ++i) in[i] = 0.57735f, h[i] = 0.1f, index[i] = i < 9 ? 1 : (uint32_t)(i * 7 / 5 % 3);
  const float *wi[3] = {in, in, in};
  hairis_hits hits = {{in, in, in}, h, index}, all_empty = {{in, in, in}, NULL, NULL};
  hairis_evals evals = {{out[0], out[1], out[2]}, out[3]};
  hairis_samples samples = {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}, out[6], {out[7], out[8], out[9]}, out[10]};
  hairis_samples directions = {{out[0], out[1], out[2]}, {NULL, NULL, NULL}, NULL, {NULL, NULL, NULL}, NULL};
  hairis_candidates candidates = {{in, in, in}, {in, in, in}, in};
  hairis_weights weights = {{out[0], out[1], out[2]}, out[3]};
  hairis_counts counts = {1, 1, HAIRIS_PARTITION_ALL};
  /* Columns that a call writes, and whether the last is that of lobes. */
#define NOTHING(call, columns)                                                                       \
  do {                                                                                               \
    memset(out, 0xa5, sizeof out);                                                                   \
    int ok = (call) == HAIRIS_OK;                                                                    \
    for (int k = 0; k < (columns); ++k)                                                              \
      for (int i = 0; i < N; ++i) ok = ok && out[k][i] == (k == 10 ? -1.0f : 0.0f);                  \
    want(ok, "nothing by " #call);                                                                   \
  } while (0)
  NOTHING(hairis_eval_columns(&none, N, wi, &evals), 4);
  NOTHING(hairis_sample_columns(&none, N, wi, &samples), 11);
  NOTHING(hairis_sample_columns(&none, N, wi, &directions), 3);
  NOTHING(hairis_weigh_columns(&none, N, &candidates, counts, &weights), 4);
  NOTHING(hairis_eval_hits(&materials[1], 1, N, &all_empty, wi, &evals), 4);
  NOTHING(hairis_sample_hits(&materials[1], 1, N, &all_empty, wi, &samples), 11);
  NOTHING(hairis_sample_hits(&materials[1], 1, N, &all_empty, wi, &directions), 3);
  /* Among others, whose hits keep their answers. */
#define AMONG(call, columns)                                                                         \
  do {                                                                                               \
    for (int i = 0; i < N; ++i) index[i] = index[i] == 1 ? 3 : index[i];                             \
    memset(out, 0xa5, sizeof out);                                                                   \
    want((call) == HAIRIS_ARGUMENT && out[0][9] == out[3][N - 1], "an index behind the materials");  \
    for (int i = 0; i < N; ++i) index[i] = index[i] == 3 ? 0 : index[i];                             \
    want((call) == HAIRIS_OK, #call);                                                                \
    memcpy(whole, out, sizeof out);                                                                  \
    for (int i = 0; i < N; ++i) index[i] = i < 9 ? 1 : (uint32_t)(i * 7 / 5 % 3);                    \
    int ok = (call) == HAIRIS_OK;                                                                    \
    for (int k = 0; k < (columns); ++k)                                                              \
      for (int i = 0; i < N; ++i)                                                                    \
        ok = ok && out[k][i] == (index[i] != 1 ? whole[k][i] : k == 10 ? -1.0f : 0.0f);              \
    want(ok, "nothing among others by " #call);                                                      \
  } while (0)
  AMONG(hairis_eval_hits(materials, 3, N, &hits, wi, &evals), 4);
  AMONG(hairis_sample_hits(materials, 3, N, &hits, wi, &samples), 11);
  AMONG(hairis_sample_hits(materials, 3, N, &hits, wi, &directions), 3);
}

/* Handles at addresses that are no multiple of 16, and handles that the library did not write. */
static void misplaced(void) {
  enum { N = 20 };
  static union { hairis_material material; hairis_bsdf bsdf; unsigned char bytes[4096]; } places[2];
  static float in[N];
  static hairis_material material;
  hairis_params params;
  hairis_bsdf bsdf;
  hairis_params_init(&params, "gaussian", NULL, NULL, &error);
  hairis_material_init(&material, &params, HAIRIS_ENERGY_CONSERVING, &error);
  hairis_prepare(&bsdf, &material, 0.6f, 0.8f, 0, 0);
  float *out = (float *)(void *)guarded;
  const float *wi[3] = {in, in, in};
  hairis_hits hits = {{in, in, in}, NULL, NULL};
  hairis_evals evals = {{out, out + N, out + 2 * N}, out + 3 * N};
  hairis_samples samples = {{out, out + N, out + 2 * N}, {NULL, NULL, NULL}, NULL, {NULL, NULL, NULL}, NULL};
  hairis_candidates candidates = {{in, in, in}, {in, in, in}, in};
  hairis_weights weights = {{out, out + N, out + 2 * N}, out + 3 * N};
  hairis_counts counts = {1, 1, HAIRIS_PARTITION_ALL};
  /* At the last, handles may lie, but these bytes are of no model. */
  static const size_t offsets[] = {1, 2, 4, 8, 12, 15, 0};
  for (size_t o = 0; o < sizeof offsets / sizeof *offsets; ++o) {
    size_t offset = offsets[o];
    hairis_material *m = (hairis_material *)(void *)(places[0].bytes + offset);
    hairis_bsdf *b = (hairis_bsdf *)(void *)(places[1].bytes + offset);
    memset(places, 0xa5, sizeof places);
    if (offset) {
      refused(hairis_material_init(m, &params, HAIRIS_ENERGY_RAW, &error), HAIRIS_ARGUMENT, "to", -1,
              "to must lie at a multiple of 16 bytes, got 0x");
      hairis_prepare(b, &material, 0.6f, 0.8f, 0, 0);
      int untouched = 1;
      for (int p = 0; p < 2; ++p)
        for (size_t i = 0; i < sizeof places[p].bytes; ++i) untouched = untouched && places[p].bytes[i] == 0xa5;
      want(untouched, "a handle is written where none may lie");
      memcpy(places[0].bytes + offset, &material, sizeof material);
      memcpy(places[1].bytes + offset, &bsdf, sizeof bsdf);
    }
    fill();
    scatters_nothing(m, b, "a misplaced handle scatters nothing");
    hairis_bsdf of_misplaced;
    hairis_prepare(&of_misplaced, m, 0.6f, 0.8f, 0, 0);
    scatters_nothing(m, &of_misplaced, "a BSDF of a misplaced material scatters nothing");
    REFUSED(hairis_eval_columns(b, N, wi, &evals));
    REFUSED(hairis_sample_columns(b, N, wi, &samples));
    REFUSED(hairis_weigh_columns(b, N, &candidates, counts, &weights));
    REFUSED(hairis_eval_hits(m, 1, N, &hits, wi, &evals));
    REFUSED(hairis_sample_hits(m, 1, N, &hits, wi, &samples));
    want(is_untouched(), "columns of a misplaced handle are written");
  }
}

/* Names, lengths and ranges of descriptions, and fields that take the place of others. */
static void descriptions(void) {
  char name[32];
  want(hairis_abi_version() == HAIRIS_ABI_VERSION && strlen(hairis_version()) > 4, "versions");
  size_t length = hairis_level_name(name, sizeof name), cut = hairis_level_name(name, 3);
  want(length == cut && strlen(name) == 2 && hairis_level_name(NULL, 0) == length, "a name that does not fit");
  for (uint32_t m = 0; m < hairis_model_count(); ++m) {
    hairis_model_info info, found_info;
    hairis_params params;
    want(hairis_model_describe(m, &info) == HAIRIS_OK, "a model");
    want(hairis_params_init(&params, info.name, info.word[0] ? info.word : NULL, NULL, &error) == HAIRIS_OK, info.name);
    want(params.model == m, "the index of a model found by its names");
    want(hairis_model_describe(params.model, &found_info) == HAIRIS_OK && memcmp(&info, &found_info, sizeof info) == 0, "descriptions");
    uint32_t numbers = 0;
    for (uint32_t f = 0; f < info.fields; ++f) {
      hairis_field_info field;
      want(hairis_field_describe(m, f, &field) == HAIRIS_OK && field.first == numbers, "a field");
      want(strlen(field.doc) > 8 && field.doc[strlen(field.doc) - 1] == '.', field.name);
      want(field.kind == HAIRIS_KIND_WORD ? field.labels > 1 : field.least < field.most, "a range, or words");
      want(field.labels <= 4, "room for all labels");
      for (uint32_t w = 0; w < field.labels; ++w) want(strlen(field.label[w]) > 0 && strlen(field.label[w]) < 15, "a label");
      if (field.kind == HAIRIS_KIND_WORD)
        want(hairis_params_set_word(&params, field.name, field.label[field.labels - 1], &error) == HAIRIS_OK &&
                 params.numbers[field.first] == (float)(field.labels - 1),
             "a word");
      numbers += field.width;
    }
    want(numbers <= HAIRIS_NUMBERS, "room for all numbers");
    for (uint32_t p = 0; p < info.presets; ++p) {
      want(hairis_preset_name(m, p, name, sizeof name) == strlen(name), "a preset's name");
      want(hairis_params_init(&params, info.name, info.word[0] ? info.word : NULL, name, &error) == HAIRIS_OK, name);
    }
  }
  hairis_params params;
  const float color[3] = {0.5f, 0.3f, 0.1f};
  hairis_params_init(&params, "chiang", NULL, NULL, &error);
  uint32_t given = params.given;
  want(hairis_params_set(&params, "color", color, 3, &error) == HAIRIS_OK && params.given != given, "a colour in place of absorption");
  uint32_t bits = 0, before = 0;
  for (uint32_t f = 0; f < 32; ++f) bits += params.given >> f & 1, before += given >> f & 1;
  want(bits == before, "one field of a group");
}

int main(void) {
  memset(&error, 0x5a, sizeof error);
  setup();
  columns();
  dual();
  empty();
  misplaced();
  descriptions();
  printf("%d refusals and descriptions, %d failed\n", checked, failed);
  return failed != 0;
}
