/* Two static libraries of Rust in one program: this one, and another with std. */
#include "hairis.h"

#include <stdio.h>

extern int other_length(const char *text);

int main(void) {
  hairis_params params;
  hairis_material material;
  hairis_bsdf bsdf;
  hairis_error error;
  if (hairis_params_init(&params, "gaussian", "matched", "brown", &error) || hairis_material_init(&material, &params, 1, &error)) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }
  hairis_prepare(&bsdf, &material, 0.6f, 0.8f, 0, 0);
  float pdf = hairis_eval_pdf(&bsdf, 0, 1, 0).pdf;
  printf("density %g beside a Rust library that counts %d\n", pdf, other_length("five!"));
  return !(pdf > 0 && other_length("five!") == 5);
}
