// Shades one hair: cc -std=c99 -O2 example.c -lm -o example && ./example
#include <stdio.h>
#include "hairis_MODEL.h"

int main(void) {
    HairisTYPEParams params = hairis_MODEL_params_brown(); // set its fields: see HairisTYPEParams in the header
    HairisTYPEMaterial hair = hairis_MODEL_material(params); // once per material
    HairisVec3 wo = {0.6f, 0.8f, 0.0f}; // towards the viewer, in the frame of the fibre, x along it
    HairisTYPEPrepared point = hairis_MODEL_prepare(hair, wo, 0.0f); // once per hit, in the middle of the fibre

    HairisVec3 wi = {-0.6f, 0.64f, 0.48f}; // towards a light
    HairisTYPEEval e = hairis_MODEL_eval(point, wi); // value is without the cosine
    printf("value %.3f %.3f %.3f, pdf %.3f\n", e.value.x, e.value.y, e.value.z, e.pdf);

    HairisVec3 xi = {0.3f, 0.6f, 0.9f}; // uniform in [0, 1)
    HairisTYPESample s = hairis_MODEL_sample(point, xi);
    if (s.slot < 0.0f) return 0; // discarded: the path ends
    printf("sample %.3f %.3f %.3f, ", s.wi.x, s.wi.y, s.wi.z);
    printf("weight %.3f %.3f %.3f\n", s.weight.x, s.weight.y, s.weight.z);
    return 0;
}
