/* Answers of the library against those of Rust's handles, to the bit: every model, preset, energy and entry point. Usage:
 * bits ANSWERS [short], the file that .ci/hosts writes. Columns are heap blocks of exactly their length, for sanitizers and valgrind;
 * with "short" those of results lack a number, which these must report. */
#include "hairis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_CASES 256

static const unsigned char *at, *end;
static unsigned long compared;
static char place[160];
/* Numbers that columns of results lack. */
static size_t lacking;

static void fail(const char *what) {
  fprintf(stderr, "FAIL %s: %s\n", place, what);
  exit(1);
}
static const void *take(size_t size) {
  const void *from = at;
  if ((size_t)(end - at) < size) fail("the file of answers ends early");
  at += size;
  return from;
}
static uint32_t word(void) {
  uint32_t w;
  memcpy(&w, take(4), 4);
  return w;
}
static void *block(size_t size) {
  void *to = malloc(size ? size : 1);
  if (!to) fail("no memory");
  return to;
}
static float *floats(size_t n) {
  float *to = block(n * sizeof(float));
  memcpy(to, take(n * sizeof(float)), n * sizeof(float));
  return to;
}
static void columns(float *to[], int count, size_t n) {
  for (int c = 0; c < count; ++c) to[c] = floats(n);
}
static void rooms(float *to[], int count, size_t n) {
  size_t size = n > lacking ? (n - lacking) * sizeof(float) : 0;
  for (int c = 0; c < count; ++c) {
    to[c] = block(size);
    memset(to[c], 0x7b, size);
  }
}
static void release(float *columns[], int count) {
  for (int c = 0; c < count; ++c) free(columns[c]);
}
/* Whether two numbers have the same bits. The direction of a discarded sample may be NaN, of which only that is promised. */
static int is_same(const void *got, const void *want) {
  float g, w;
  memcpy(&g, got, 4);
  memcpy(&w, want, 4);
  return memcmp(got, want, 4) == 0 || (g != g && w != w);
}
static void same(const void *got, size_t size, const char *what) {
  const unsigned char *want = take(size);
  int differ = 0;
  compared += size / 4;
  for (size_t i = 0; i + 4 <= size; i += 4) {
    const unsigned char *one = (const unsigned char *)got + i;
    float g, w;
    if (is_same(one, want + i)) continue;
    memcpy(&g, one, 4);
    memcpy(&w, want + i, 4);
    fprintf(stderr, "number %lu is %.9g, in Rust %.9g\n", (unsigned long)(i / 4), g, w);
    differ = 1;
  }
  if (differ) fail(what);
}
static void same_columns(float *got[], int count, size_t n, const char *what) {
  for (int c = 0; c < count; ++c) same(got[c], n * sizeof(float), what);
}
static void equal(float *a[], float *b[], int count, size_t n, const char *what) {
  for (int c = 0; c < count; ++c)
    if (memcmp(a[c], b[c], n * sizeof(float)) != 0) fail(what);
}
static void ok(hairis_status status, const char *what) {
  if (status != HAIRIS_OK) fail(what);
}

static hairis_evals evals_of(float *c[4]) {
  hairis_evals to = {{c[0], c[1], c[2]}, c[3]};
  return to;
}
static hairis_samples samples_of(float *c[11]) {
  hairis_samples to = {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, c[6], {c[7], c[8], c[9]}, c[10]};
  return to;
}

/* A material: 1 if the library has its model. */
static int material(hairis_material *to) {
  char model[32], choice[32], preset[32];
  hairis_params params;
  hairis_error error;
  memcpy(model, take(32), 32);
  memcpy(choice, take(32), 32);
  memcpy(preset, take(32), 32);
  uint32_t energy = word();
  snprintf(place, sizeof place, "%s %s %s, energy %u", model, choice, preset, (unsigned)energy);
  hairis_status status = hairis_params_init(&params, model, choice[0] ? choice : NULL, preset, &error);
  if (status == HAIRIS_NAME && getenv("HAIRIS_MAY_LACK")) return 0;
  if (status != HAIRIS_OK || hairis_material_init(to, &params, energy, &error) != HAIRIS_OK) fail(error.message);
  return 1;
}

static void points(const hairis_bsdf *bsdf) {
  float albedo[HAIRIS_LOBES][3];
  hairis_albedo(bsdf, albedo);
  same(albedo, sizeof albedo, "hairis_albedo");
  for (int i = 0; i < 12; ++i) {
    float wi[3], xi[3];
    memcpy(wi, take(12), 12);
    memcpy(xi, take(12), 12);
    hairis_eval_result eval = hairis_eval_pdf(bsdf, wi[0], wi[1], wi[2]);
    same(&eval, sizeof eval, "hairis_eval_pdf");
    hairis_lobe_result lobes[HAIRIS_LOBES];
    hairis_lobes(bsdf, wi[0], wi[1], wi[2], lobes);
    same(lobes, sizeof lobes, "hairis_lobes");
    hairis_sample_result s = hairis_sample(bsdf, xi[0], xi[1], xi[2]);
    same(&s.lobe, 4, "lobe of hairis_sample");
    same(&s, 40, "hairis_sample");
  }
}

static void at_hit(const hairis_bsdf *bsdf) {
  size_t n = word();
  float *wi[3], *xi[3], *eval[4], *sample[11], *only[11], *proposed[3];
  columns(wi, 3, n);
  rooms(eval, 4, n);
  hairis_evals evals = evals_of(eval);
  ok(hairis_eval_columns(bsdf, n, (const float *const *)wi, &evals), "hairis_eval_columns");
  same_columns(eval, 4, n, "hairis_eval_columns");
  /* Any column alone. */
  for (int c = 0; c < 4; ++c) {
    float *one[4] = {NULL, NULL, NULL, NULL};
    rooms(&one[c], 1, n);
    evals = evals_of(one);
    ok(hairis_eval_columns(bsdf, n, (const float *const *)wi, &evals), "hairis_eval_columns, one column");
    equal(&one[c], &eval[c], 1, n, "hairis_eval_columns, one column");
    free(one[c]);
  }

  columns(xi, 3, n);
  rooms(sample, 11, n);
  hairis_samples samples = samples_of(sample);
  ok(hairis_sample_columns(bsdf, n, (const float *const *)xi, &samples), "hairis_sample_columns");
  same_columns(sample, 11, n, "hairis_sample_columns");
  memset(only, 0, sizeof only);
  rooms(only, 3, n);
  rooms(&only[6], 4, n);
  samples = samples_of(only);
  ok(hairis_sample_columns(bsdf, n, (const float *const *)xi, &samples), "hairis_sample_columns, wi, pdf, weight");
  equal(only, sample, 3, n, "hairis_sample_columns, wi of wi, pdf, weight");
  equal(&only[6], &sample[6], 4, n, "hairis_sample_columns, pdf and weight of wi, pdf, weight");
  release(&only[6], 4);
  memset(&only[6], 0, 4 * sizeof(float *));
  samples = samples_of(only);
  ok(hairis_sample_columns(bsdf, n, (const float *const *)xi, &samples), "hairis_sample_columns, wi");
  same_columns(only, 3, n, "hairis_sample_columns, wi alone");
  memcpy(proposed, only, sizeof proposed);

  float *radiance[3], *pdf_light, *weigh[4];
  columns(radiance, 3, n);
  pdf_light = floats(n);
  hairis_counts counts = {0, 0, 0};
  counts.bsdf = word();
  counts.light = word();
  counts.partition = word();
  rooms(weigh, 4, n);
  hairis_candidates candidates = {{proposed[0], proposed[1], proposed[2]}, {radiance[0], radiance[1], radiance[2]}, pdf_light};
  hairis_weights weights = {{weigh[0], weigh[1], weigh[2]}, weigh[3]};
  ok(hairis_weigh_columns(bsdf, n, &candidates, counts, &weights), "hairis_weigh_columns");
  same_columns(weigh, 4, n, "hairis_weigh_columns");
  uint32_t k = word();
  float u;
  memcpy(&u, take(4), 4);
  hairis_choice *choices = block(k * sizeof *choices);
  size_t count = hairis_choose(&weights, n, k, u, choices);
  if (count != word() || count > k) fail("number of hairis_choose");
  for (size_t i = 0; i < count; ++i) {
    if (choices[i].index != word() || choices[i].count != word()) fail("choice of hairis_choose");
    same(choices[i].contribution, 12, "contribution of hairis_choose");
  }
  free(choices);
  release(wi, 3), release(xi, 3), release(eval, 4), release(sample, 11), release(proposed, 3);
  release(radiance, 3), free(pdf_light), release(weigh, 4);
}

/* Over hits: all columns, and some of them. index is NULL or of n entries. */
static void over_hits(const hairis_material *materials, size_t count, size_t n, float *wo[3], float *h, float *wi[3],
                      float *xi[3], const uint32_t *index, float *eval[4], float *sample[11]) {
  float *some[11];
  hairis_hits hits = {{wo[0], wo[1], wo[2]}, h, index};
  rooms(eval, 4, n), rooms(sample, 11, n);
  hairis_evals evals = evals_of(eval);
  hairis_samples samples = samples_of(sample);
  ok(hairis_eval_hits(materials, count, n, &hits, (const float *const *)wi, &evals), "hairis_eval_hits");
  ok(hairis_sample_hits(materials, count, n, &hits, (const float *const *)xi, &samples), "hairis_sample_hits");
  memset(some, 0, sizeof some);
  rooms(&some[3], 1, n);
  evals = evals_of((float *[4]){NULL, NULL, NULL, some[3]});
  ok(hairis_eval_hits(materials, count, n, &hits, (const float *const *)wi, &evals), "hairis_eval_hits, pdf");
  equal(&some[3], &eval[3], 1, n, "hairis_eval_hits, pdf alone");
  release(&some[3], 1);
  some[3] = NULL;
  rooms(some, 3, n);
  samples = samples_of(some);
  ok(hairis_sample_hits(materials, count, n, &hits, (const float *const *)xi, &samples), "hairis_sample_hits, wi");
  for (size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) {
      float want = sample[6][i] > 0 ? sample[c][i] : 0;
      if (memcmp(&some[c][i], &want, 4) != 0) fail("hairis_sample_hits, wi alone");
    }
  release(some, 3);
}

static void hits(const hairis_material *one) {
  size_t n = word();
  float *wo[3], *h, *wi[3], *xi[3], *eval[4], *sample[11];
  columns(wo, 3, n);
  h = floats(n);
  columns(wi, 3, n), columns(xi, 3, n);
  over_hits(one, 1, n, wo, h, wi, xi, NULL, eval, sample);
  same_columns(eval, 4, n, "hairis_eval_hits"), same_columns(sample, 11, n, "hairis_sample_hits");
  release(wo, 3), free(h), release(wi, 3), release(xi, 3), release(eval, 4), release(sample, 11);
}

static void skip_hits(void) {
  size_t n = word();
  take((3 + 1 + 3 + 3 + 4 + 11) * n * sizeof(float));
}

static void skip_case(void) {
  take(4);
  for (int round = 0; round < 4; ++round) {
    take(16);
    for (int restricted = 0; restricted < 2; ++restricted) {
      take(HAIRIS_LOBES * 12 + 12 * (24 + 16 + HAIRIS_LOBES * 20 + 4 + 40));
      if (restricted) continue;
      size_t n = word();
      take((3 + 4 + 3 + 11 + 3 + 3 + 1) * n * sizeof(float) + 12 + 4 * n * sizeof(float) + 8);
      size_t count = word();
      take(count * 20 + 4);
    }
  }
  for (int round = 0; round < 4; ++round) skip_hits();
}

static void table(void) {
  size_t count = word();
  static hairis_material all[MOST_CASES];
  int present[MOST_CASES];
  if (count > MOST_CASES) fail("too many materials");
  for (size_t m = 0; m < count; ++m) present[m] = material(&all[m]);
  snprintf(place, sizeof place, "table of %lu materials", (unsigned long)count);
  hairis_material *materials = block(count * sizeof *materials);
  memcpy(materials, all, count * sizeof *materials);
  size_t n = word(), kept = 0;
  float *wo[3], *h, *wi[3], *xi[3], *eval[4], *sample[11];
  columns(wo, 3, n);
  h = floats(n);
  columns(wi, 3, n), columns(xi, 3, n);
  uint32_t *index = block(n * sizeof *index);
  size_t *row = block(n * sizeof *row);
  /* The rows whose models the library has. */
  for (size_t i = 0; i < n; ++i) {
    uint32_t m = word();
    if (!present[m]) continue;
    for (int c = 0; c < 3; ++c) wo[c][kept] = wo[c][i], wi[c][kept] = wi[c][i], xi[c][kept] = xi[c][i];
    h[kept] = h[i], row[kept] = i, index[kept++] = m;
  }
  over_hits(materials, count, kept, wo, h, wi, xi, index, eval, sample);
  for (int c = 0; c < 15; ++c) {
    const unsigned char *want = take(n * sizeof(float));
    for (size_t i = 0; i < kept; ++i)
      if (!is_same(c < 4 ? &eval[c][i] : &sample[c - 4][i], want + 4 * row[i])) fail("a hit of the table");
    compared += kept;
  }
  release(wo, 3), free(h), release(wi, 3), release(xi, 3), release(eval, 4), release(sample, 11);
  free(materials), free(index), free(row);
}

/* Dual scattering of one material, under random light. */
static void dual(void) {
  hairis_material one;
  hairis_dual averages;
  if (!material(&one) || hairis_dual_init(&averages, &one) != HAIRIS_OK) fail("averages of a material");
  snprintf(place, sizeof place, "dual scattering");
  same(averages.coefficients, sizeof averages.coefficients, "hairis_dual_init");
  for (int round = 0; round < 40; ++round) {
    float wo[3], wi[3], number[2], gain[2] = {HAIRIS_DUAL_GAIN, HAIRIS_DUAL_GAIN}, single[3] = {0.25f, 0.5f, 1}, value[3];
    memcpy(wo, take(12), 12), memcpy(wi, take(12), 12), memcpy(number, take(8), 8);
    hairis_crossed crossed = hairis_dual_strands(&averages, number[0], number[1]);
    same(&crossed, sizeof crossed, "hairis_dual_strands");
    crossed = hairis_dual_depth(&averages, number[0], number[1]);
    same(&crossed, sizeof crossed, "hairis_dual_depth");
    hairis_dual_through(&crossed, &averages, number[0]);
    same(&crossed, sizeof crossed, "hairis_dual_through");
    hairis_dual_shade(&averages, wo, wi, single, &crossed, gain, value);
    same(value, sizeof value, "hairis_dual_shade");
  }
}

/* Parameters of two materials that have a colour. */
static void colors(void) {
  for (int round = 0; round < 2; ++round) {
    hairis_params params;
    const char *model = take(32);
    float color[3];
    memcpy(color, take(sizeof color), sizeof color);
    if (hairis_params_init(&params, model, NULL, NULL, NULL) || hairis_params_set_color(&params, color, "fibre", NULL)) fail("a colour");
    snprintf(place, sizeof place, "colour of %s", model);
    same(params.numbers, sizeof params.numbers, "hairis_params_set_color");
  }
}

int main(int count, char **arguments) {
  FILE *file = count == 2 || count == 3 ? fopen(arguments[1], "rb") : NULL;
  if (!file || fseek(file, 0, SEEK_END)) return fprintf(stderr, "usage: bits ANSWERS [short]\n"), 2;
  lacking = count == 3;
  size_t size = (size_t)ftell(file);
  rewind(file);
  unsigned char *bytes = block(size);
  if (fread(bytes, 1, size, file) != size) return 2;
  fclose(file);
  at = bytes, end = bytes + size;

  snprintf(place, sizeof place, "frames");
  for (int round = 0; round < 40; ++round) {
    float in[9], frame[9];
    memcpy(in, take(sizeof in), sizeof in);
    hairis_frame(in, round % 2 ? in + 3 : NULL, frame);
    same(frame, sizeof frame, "hairis_frame");
    float h = hairis_offset(frame, in + 3, in + 6);
    same(&h, 4, "hairis_offset");
  }
  uint32_t cases = word(), left_out = 0;
  for (uint32_t i = 0; i < cases; ++i) {
    hairis_material *one = block(sizeof *one), copy;
    if (!material(one)) {
      skip_case(), free(one), ++left_out;
      continue;
    }
    /* Handles are plain data. */
    copy = *one;
    float most = hairis_material_max_albedo(&copy);
    same(&most, 4, "hairis_material_max_albedo");
    for (int round = 0; round < 4; ++round) {
      float wo[4];
      memcpy(wo, take(sizeof wo), sizeof wo);
      hairis_bsdf bsdf;
      hairis_prepare(&bsdf, one, wo[0], wo[1], wo[2], wo[3]);
      points(&bsdf);
      at_hit(&bsdf);
      hairis_restrict(&bsdf, word());
      points(&bsdf);
    }
    for (int round = 0; round < 4; ++round) hits(one);
    free(one);
  }
  table();
  dual();
  colors();
  if (at != end) fail("the file of answers is longer");
  free(bytes);
  char level[32];
  hairis_level_name(level, sizeof level);
  printf("%lu numbers of %u materials are Rust's to the bit on %s", compared, (unsigned)(cases - left_out), level);
  if (left_out) printf("; %u are not in the library", (unsigned)left_out);
  printf("\n");
  return 0;
}
