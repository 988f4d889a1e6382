/* A host without an operating system, in C: a material, a hit, a direction and a sample. */
#include <hairis.h>

void say(const char *text);
void paint_stack(void);
uint32_t stack_used(void);
_Noreturn void quit(int code);

/* The library calls it where a panic ends the program. */
_Noreturn void abort(void) {
  say("panic\n");
  quit(101);
}

static void print(const char *name, uint32_t bits) {
  char digits[10] = {0};
  for (int i = 0; i < 8; ++i) digits[i] = "0123456789abcdef"[bits >> (28 - 4 * i) & 15];
  digits[8] = '\n';
  say(name);
  say(digits);
}
static void number(const char *name, float x) {
  union {
    float x;
    uint32_t bits;
  } number = {x};
  print(name, number.bits);
}

int host(void) {
  hairis_params params;
  hairis_error error;
  hairis_material hair;
  hairis_bsdf bsdf;
  if (hairis_params_init(&params, "gaussian", "matched", "brown", &error) != HAIRIS_OK ||
      hairis_material_init(&hair, &params, HAIRIS_ENERGY_CONSERVING, &error) != HAIRIS_OK) {
    say(error.message);
    return 1;
  }
  print("set-up, bytes of stack ", stack_used());

  paint_stack();
  hairis_prepare(&bsdf, &hair, 0.6f, 0.0f, 0.8f, 0);
  hairis_eval_result eval = hairis_eval_pdf(&bsdf, -0.6f, 0.8f, 0.0f);
  hairis_sample_result sample = hairis_sample(&bsdf, 0.3f, 0.6f, 0.9f);
  print("hit, bytes of stack ", stack_used());
  number("value ", eval.value[0]);
  number("pdf ", eval.pdf);
  number("wi.x ", sample.wi[0]);
  number("weight ", sample.weight[0]);
  return 0;
}
