/* Floating-point exceptions that calls of the library raise: invalid operation, division by zero and overflow, for every model, sampler,
 * preset, energy and call, on everyday input. A compiler that packs scalars computes lanes that nothing reads, and whether their content
 * traps depends on the build: hence this program, which links what is shipped. Usage:
 *   exceptions        prints a table of calls by entries, and exits with 1 if a call raised an exception or if the control raised none
 *   exceptions trap   makes the same calls where an exception ends the program */
#define _GNU_SOURCE
#include "hairis.h"

#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WATCHED (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)
enum { HITS = 400, WIDTH = 21 };

static const char *const call_names[] = {"material_init", "max_albedo", "frame", "offset", "prepare", "restrict", "albedo",
                                         "eval_pdf", "lobes", "sample", "eval_columns", "sample_columns", "eval_hits",
                                         "sample_hits", "weigh_columns", "choose", "dual_init", "dual_strands", "dual_depth", "dual_through",
                                         "dual_shade", "params_set_color", "control"};
enum { INIT, MAX_ALBEDO, FRAME, OFFSET, PREPARE, RESTRICT, ALBEDO, EVAL, LOBES, SAMPLE, EVAL_COLUMNS, SAMPLE_COLUMNS, EVAL_HITS,
       SAMPLE_HITS, WEIGH, CHOOSE, DUAL_INIT, DUAL_STRANDS, DUAL_DEPTH, DUAL_THROUGH, DUAL_SHADE, SET_COLOR, CONTROL, CALLS };
static unsigned long made[CALLS], raising[CALLS];
static int flags_of[CALLS], traps;

#define CALL(which, ...)                            \
  do {                                              \
    if (!traps) feclearexcept(FE_ALL_EXCEPT);       \
    __VA_ARGS__;                                    \
    int flags = traps ? 0 : fetestexcept(WATCHED);  \
    ++made[which];                                  \
    raising[which] += flags != 0;                   \
    flags_of[which] |= flags;                       \
  } while (0)

static uint32_t state = 1;
/* A uniform number in [0, 1), not 0. */
static float uniform(void) {
  state = state * 747796405u + 2891336453u;
  uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (float)((word >> 8) | 1) * 0x1p-24f;
}
static void direction(float to[3]) {
  float u = 2 * uniform() - 1, turn = 6.2831853f * uniform(), plane = sqrtf(1 - u * u);
  to[0] = u, to[1] = plane * cosf(turn), to[2] = plane * sinf(turn);
}

/* Every call with one material. */
static void calls(const hairis_material *hair) {
  static float numbers[24][WIDTH];
  float total = 0;
  for (int i = 0; i < HITS; ++i) {
    float wo[3], wi[3], frame[9], tangent[3], normal[3], lobes[HAIRIS_LOBES][3], h = 2 * uniform() - 1;
    hairis_bsdf bsdf;
    hairis_lobe_result each[HAIRIS_LOBES];
    hairis_eval_result eval;
    hairis_sample_result sample;
    hairis_choice choice[4];
    direction(wo), direction(wi), direction(tangent), direction(normal);
    CALL(FRAME, hairis_frame(tangent, normal, frame));
    CALL(OFFSET, total += hairis_offset(frame, normal, wo));
    CALL(PREPARE, hairis_prepare(&bsdf, hair, wo[0], wo[1], wo[2], h));
    if (i % 8 == 0) CALL(RESTRICT, hairis_restrict(&bsdf, i / 8 % 15 + 1));
    CALL(ALBEDO, hairis_albedo(&bsdf, lobes));
    CALL(EVAL, eval = hairis_eval_pdf(&bsdf, wi[0], wi[1], wi[2]));
    CALL(LOBES, hairis_lobes(&bsdf, wi[0], wi[1], wi[2], each));
    float xi[3] = {uniform(), uniform(), uniform()};
    CALL(SAMPLE, sample = hairis_sample(&bsdf, xi[0], xi[1], xi[2]));
    total += eval.pdf + sample.pdf + each[0].pdf + lobes[0][0];
    if (i % 8) continue;
    for (int n = 0; n < WIDTH; ++n) {
      float v[3];
      direction(v);
      for (int c = 0; c < 3; ++c) numbers[c][n] = v[c], numbers[3 + c][n] = uniform(), numbers[6 + c][n] = uniform();
      direction(v);
      for (int c = 0; c < 3; ++c) numbers[9 + c][n] = v[c];
      numbers[12][n] = 2 * uniform() - 1, numbers[13][n] = uniform();
    }
    const float *const to_light[3] = {numbers[0], numbers[1], numbers[2]}, *const random[3] = {numbers[3], numbers[4], numbers[5]};
    hairis_hits hits = {{numbers[9], numbers[10], numbers[11]}, numbers[12], NULL};
    hairis_evals evals = {{numbers[14], numbers[15], numbers[16]}, numbers[17]};
    hairis_samples samples = {{numbers[18], numbers[19], numbers[20]}, {numbers[14], numbers[15], numbers[16]}, numbers[17],
                              {numbers[21], numbers[22], numbers[23]}, NULL};
    hairis_candidates candidates = {{numbers[0], numbers[1], numbers[2]}, {numbers[6], numbers[7], numbers[8]}, numbers[13]};
    hairis_weights weights = {{numbers[14], numbers[15], numbers[16]}, numbers[17]};
    int bad = 0;
    CALL(EVAL_COLUMNS, bad |= hairis_eval_columns(&bsdf, WIDTH, to_light, &evals));
    CALL(SAMPLE_COLUMNS, bad |= hairis_sample_columns(&bsdf, WIDTH, random, &samples));
    CALL(EVAL_HITS, bad |= hairis_eval_hits(hair, 1, WIDTH, &hits, to_light, &evals));
    CALL(SAMPLE_HITS, bad |= hairis_sample_hits(hair, 1, WIDTH, &hits, random, &samples));
    for (uint32_t partition = 0; partition < 3; ++partition) {
      hairis_counts counts = {8, WIDTH - 8, partition};
      CALL(WEIGH, bad |= hairis_weigh_columns(&bsdf, WIDTH, &candidates, counts, &weights));
      CALL(CHOOSE, bad |= hairis_choose(&weights, WIDTH, 4, uniform(), choice) > 4);
    }
    if (bad) {
      puts("FAIL a call was refused");
      exit(1);
    }
  }
  if (!(total < INFINITY)) puts("FAIL a result is not finite"), exit(1);
}

/* Dual scattering of one material. */
static void dual_scattering(const hairis_material *hair) {
  hairis_dual dual;
  hairis_status refused;
  CALL(DUAL_INIT, refused = hairis_dual_init(&dual, hair));
  float total = 0;
  for (int i = 0; i < HITS; ++i) {
    float wo[3], wi[3], single[3] = {uniform(), uniform(), uniform()}, gain[2] = {HAIRIS_DUAL_GAIN, HAIRIS_DUAL_GAIN}, value[3];
    float theta = 3 * uniform() - 1.5f, count = i % 4 ? 9 * uniform() : (float)(i % 3);
    hairis_crossed strands, depth;
    direction(wo), direction(wi);
    CALL(DUAL_STRANDS, strands = hairis_dual_strands(&dual, theta, count));
    CALL(DUAL_DEPTH, depth = hairis_dual_depth(&dual, theta, count));
    CALL(DUAL_THROUGH, hairis_dual_through(&strands, &dual, theta));
    CALL(DUAL_SHADE, hairis_dual_shade(&dual, wo, wi, single, i % 2 ? &strands : &depth, gain, value));
    total += value[0] + value[1] + value[2];
  }
  if (refused || !(total < INFINITY)) puts("FAIL a result of dual scattering is not finite"), exit(1);
}

/* Every call with a material that the parameters describe. */
static void material(const hairis_params *params, uint32_t energy) {
  hairis_material hair;
  hairis_status refused;
  CALL(INIT, refused = hairis_material_init(&hair, params, energy, NULL));
  float most = 0;
  CALL(MAX_ALBEDO, most = hairis_material_max_albedo(&hair));
  if (refused || !(most < INFINITY)) puts("FAIL a material is refused"), exit(1);
  calls(&hair);
  if (energy == HAIRIS_ENERGY_CONSERVING) dual_scattering(&hair);
}

/* Lobes without energy: each colour black in turn, and then all of them. */
static void dark(hairis_params params, const hairis_model_info *info) {
  static const float black[3];
  hairis_params all = params;
  for (uint32_t field = 0; field < info->fields; ++field) {
    hairis_params one = params;
    hairis_field_info at;
    hairis_field_describe(params.model, field, &at);
    if (at.kind != HAIRIS_KIND_RGB) continue;
    hairis_params_set(&one, at.name, black, 3, NULL);
    hairis_params_set(&all, at.name, black, 3, NULL);
    material(&one, field % 3);
  }
  for (uint32_t energy = 0; energy < 3; ++energy) material(&all, energy);
}

/* Parameters that show colours, of which the first two are out of reach. A model without a colour is refused. */
static void colors(hairis_params params) {
  static const float asked[3][3] = {{0, 0, 0}, {1, 2, 1e30f}, {0.6f, 0.3f, 0.1f}};
  for (int of = 0; of < 3; ++of)
    for (int i = 0; i < 3; ++i) {
      hairis_status refused;
      CALL(SET_COLOR, refused = hairis_params_set_color(&params, asked[i], of == 0 ? "fibre" : of == 1 ? "mass" : "chiang", NULL));
      if (refused && refused != HAIRIS_NAME && refused != HAIRIS_VALUE) puts("FAIL a colour is refused"), exit(1);
    }
}

int main(int count, char **arguments) {
  int bad = 0;
  traps = count > 1 && !strcmp(arguments[1], "trap");
  if (traps) feenableexcept(WATCHED);
  for (uint32_t model = 0; model < hairis_model_count(); ++model) {
    hairis_model_info info;
    memset(made, 0, sizeof made), memset(raising, 0, sizeof raising), memset(flags_of, 0, sizeof flags_of);
    hairis_model_describe(model, &info);
    for (uint32_t preset = 0; preset < info.presets; ++preset)
      for (uint32_t energy = 0; energy < 3; ++energy) {
        char name[64];
        hairis_params params;
        hairis_preset_name(model, preset, name, sizeof name);
        if (hairis_params_init(&params, info.name, info.choice[0] ? info.word : NULL, name, NULL)) return 2;
        if (preset == 0 && energy == 0) colors(params);
        if (preset == 0 && energy == 0) dark(params, &info);
        material(&params, energy);
      }
    if (traps) continue;
    volatile float zero = 0, quotient;
    CALL(CONTROL, quotient = zero / zero);
    (void)quotient;
    if (flags_of[CONTROL] != FE_INVALID) printf("FAIL the control raised no exception\n"), bad = 1;
    for (int which = 0; which < CONTROL; ++which)
      if (raising[which]) {
        printf("FAIL %s %s %s: %lu of %lu calls raise%s%s%s\n", info.name, info.word, call_names[which], raising[which], made[which],
               flags_of[which] & FE_INVALID ? " invalid" : "", flags_of[which] & FE_DIVBYZERO ? " division by zero" : "",
               flags_of[which] & FE_OVERFLOW ? " overflow" : "");
        bad = 1;
      }
  }
  if (!bad) printf("%u entries of %d calls: no exceptions%s\n", hairis_model_count(), CONTROL, traps ? ", with traps" : "");
  return bad;
}
