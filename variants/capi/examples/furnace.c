/* A furnace in C: brown hair of every model under light of radiance 1 from everywhere. The mean weight of samples is the albedo.
 *   cc furnace.c $(pkg-config --cflags --libs hairis) -lm && ./a.out */
#include <hairis.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 256, SAMPLES = SIDE * SIDE };

int main(void) {
  int bad = 0;
  float *numbers = malloc(6 * SAMPLES * sizeof *numbers);
  if (!numbers) return 2;
  float *const xi[3] = {numbers, numbers + SAMPLES, numbers + 2 * SAMPLES}, *const weight[3] = {numbers + 3 * SAMPLES, numbers + 4 * SAMPLES, numbers + 5 * SAMPLES};
  /* A rank-1 lattice: even in all three dimensions. */
  for (int i = 0; i < SAMPLES; ++i)
    for (int d = 0; d < 3; ++d) {
      double x = (i + 0.5) * (d == 0 ? 1.0 / SAMPLES : d == 1 ? 0.75487766624669276 : 0.56984029099805327);
      xi[d][i] = fminf((float)(x - floor(x)), 1 - 0x1p-24f);
    }
  printf("%-11s %-10s %9s %9s\n", "model", "", "furnace", "albedo");
  for (uint32_t m = 0; m < hairis_model_count(); ++m) {
    hairis_model_info info;
    hairis_params params;
    hairis_material hair;
    hairis_bsdf bsdf;
    hairis_error error;
    hairis_model_describe(m, &info);
    if (hairis_params_init(&params, info.name, info.word[0] ? info.word : NULL, "brown", &error) ||
        hairis_material_init(&hair, &params, HAIRIS_ENERGY_CONSERVING, &error)) {
      fprintf(stderr, "%s\n", error.message);
      return 1;
    }
    hairis_prepare(&bsdf, &hair, 0.6f, 0.8f, 0, 0.3f);
    hairis_samples to = {.weight = {weight[0], weight[1], weight[2]}};
    if (hairis_sample_columns(&bsdf, SAMPLES, (const float *const[3]){xi[0], xi[1], xi[2]}, &to)) return 1;
    double furnace = 0, albedo = 0;
    for (int i = 0; i < SAMPLES; ++i) furnace += weight[0][i] / SAMPLES;
    float lobes[HAIRIS_LOBES][3];
    hairis_albedo(&bsdf, lobes);
    for (int lobe = 0; lobe < HAIRIS_LOBES; ++lobe) albedo += lobes[lobe][0];
    printf("%-11s %-10s %9.5f %9.5f\n", info.name, info.word, furnace, albedo);
    bad |= !(fabs(furnace / albedo - 1) < 0.01);
  }
  free(numbers);
  return bad;
}
