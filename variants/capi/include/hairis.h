/* hairis: hair scattering for renderers. C interface, version 1.
 *
 * Ownership. Every struct is plain data of the caller: memcpy copies it, nothing needs to be destroyed, and the library allocates
 * nothing. Handles, which are materials and BSDFs, are valid only in the process that made them.
 *
 * Empty handles. A material or BSDF whose bytes are all zero scatters nothing in any call, over hits as well: values, densities, weights
 * and albedos are 0, and samples are discarded. This is no error.
 *
 * Alignment. Handles lie at multiples of 16 bytes, as compilers place them. malloc does so on most systems, but a memory pool of the host
 * may not. A handle at another address, or whose first number is of no model, is HAIRIS_ARGUMENT where a function returns hairis_status.
 * Other functions take such a handle for an empty one, and write nothing there.
 *
 * Threads. Calls share no state except the features of the CPU. Any number of calls may run at once, as long as none of them writes
 * data that another call reads.
 *
 * Directions point away from the fibre, in its frame: u runs along the fibre from root to tip, and v and w lie across it. wo points
 * towards the viewer and wi towards the light, both of unit length. Values are S without the cosine, linear RGB, per steradian, and
 * densities are per steradian. A weight is S cos(theta_i) / pdf, where cos(theta_i) = sqrt(v^2 + w^2). Angles are in radians.
 * Non-finite directions evaluate to zero.
 *
 * Pointers must not be NULL unless a comment allows it. Columns hold n numbers each, at any address of a float; an output must not
 * overlap any other column.
 *
 * Errors. Only functions that return hairis_status report errors. On an error, a function writes at most to *error, which may be
 * NULL, and nowhere else. With n = 0 a call succeeds whatever its pointers are. */
#ifndef HAIRIS_H
#define HAIRIS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define HAIRIS_ALIGN(n) alignas(n)
extern "C" {
#else
#define HAIRIS_ALIGN(n) _Alignas(n)
#endif

/* Version of the interface, which is the number in libhairis.so.1. The version rises when a struct, a size or a meaning changes, but
 * not for new functions, models or fields. */
#define HAIRIS_ABI_VERSION 1
#define HAIRIS_MATERIAL_SIZE 1536
#define HAIRIS_BSDF_SIZE 1024
#define HAIRIS_NUMBERS 48
#define HAIRIS_LOBES 5 /* slots of lobes; a model with fewer leaves the others 0 */

typedef int32_t hairis_status;
enum {
  HAIRIS_OK = 0,
  HAIRIS_NAME = 1,    /* there is no such model, choice, preset, field or word */
  HAIRIS_VALUE = 2,   /* a value is out of its range, or the field has another count of numbers */
  HAIRIS_ARGUMENT = 3 /* a pointer is NULL, a code is unknown, a handle is misplaced or not of the library, or an index is
                        * out of range */
};
enum {
  HAIRIS_ENERGY_RAW = 0,        /* the model as it is: the published model may return more light than arrives */
  HAIRIS_ENERGY_CONSERVING = 1, /* no direction returns more light than arrives; not reciprocal where this limit changes the model */
  HAIRIS_ENERGY_SCALED = 2      /* one factor on all colours: reciprocal, and darker */
};
enum { HAIRIS_KIND_NUMBER = 0, HAIRIS_KIND_NUMBERS = 1, HAIRIS_KIND_RGB = 2, HAIRIS_KIND_WORD = 3 };
enum {
  HAIRIS_PARTITION_ALL = 0,     /* resampling estimates all light */
  HAIRIS_PARTITION_BALANCE = 1, /* the light technique's share by the balance heuristic; the next BSDF sample adds the rest */
  HAIRIS_PARTITION_POWER = 2    /* the light technique's share by the power heuristic */
};

/* An error: the field, the number at fault (-1 for the whole field), the value of that number, and a sentence. */
typedef struct hairis_error {
  hairis_status code;
  int32_t number;
  float value;
  char field[32];
  char message[212];
} hairis_error;

typedef struct hairis_model_info {
  char name[32];   /* "gaussian", "cauchy", "kajiya-kay", "chiang", "d-eon"; entries with other samplers share it */
  char choice[32]; /* the field that selects among them, "" if there is one entry */
  char word[32];   /* the word of that field that selects this entry */
  char lobe_names[HAIRIS_LOBES][16];
  uint32_t lobes, fields, presets;
  uint32_t near_field; /* 1: the model reads h */
  uint32_t is_default; /* 1: the first entry of its name */
} hairis_model_info;

typedef struct hairis_field_info {
  char name[32];
  char instead_of[32]; /* the field that this one may take the place of, or "" */
  uint32_t kind;       /* HAIRIS_KIND_ */
  uint32_t width;      /* count of numbers */
  uint32_t first;      /* place of its first number in hairis_params.numbers */
  uint32_t optional;   /* 1: may be left out of files */
  float least, most;   /* accepted range, both ends included; 0 and 0 for words */
  uint32_t labels;     /* count of entries in label */
  char label[4][16];   /* the words of KIND_WORD; the name of each number of KIND_NUMBERS */
  char unit[8];        /* "rad" or "" */
  char doc[128];
} hairis_field_info;

/* Values of a model's fields. Bit i of given is set if field i has a value. A word is stored as its place among the words. */
typedef struct hairis_params {
  uint32_t model;
  uint32_t given;
  float numbers[HAIRIS_NUMBERS];
} hairis_params;

/* The published model in an artist's terms: each colour is multiplied by its intensity, and angles are in degrees. */
typedef struct hairis_highlight { float color[3], intensity, shift_deg, width_deg; } hairis_highlight;
typedef struct hairis_transmission {
  float color[3], intensity, shift_deg, width_deg, azimuthal_width_deg;
} hairis_transmission;
typedef struct hairis_glints { float strength, separation_deg, azimuthal_width_deg; } hairis_glints;
typedef struct hairis_artist {
  hairis_highlight primary;         /* R: white or nearly so */
  hairis_transmission transmission; /* TT */
  hairis_highlight secondary;       /* TRT: in the colour of the hair */
  hairis_glints glints;
} hairis_artist;

/* A model with its parameters, made once per material. */
typedef struct hairis_material {
  HAIRIS_ALIGN(16) uint32_t head[4];
  unsigned char body[HAIRIS_MATERIAL_SIZE - 16];
} hairis_material;
/* A material at a hit, seen from wo; made once per hit. */
typedef struct hairis_bsdf {
  HAIRIS_ALIGN(16) uint32_t head[4];
  unsigned char body[HAIRIS_BSDF_SIZE - 16];
} hairis_bsdf;

typedef struct hairis_eval_result { float value[3], pdf; } hairis_eval_result;
/* A lobe's part of S is value * color; pdf is the density of sampling from it alone. */
typedef struct hairis_lobe_result { float value, color[3], pdf; } hairis_lobe_result;
/* For a discarded sample, lobe is -1 and all other fields are 0. Such a sample counts, with a contribution of 0: do not redraw it. */
typedef struct hairis_sample_result { float wi[3], pdf, value[3], weight[3]; int32_t lobe; } hairis_sample_result;

/* Averages of a fibre's scattering as polynomials of the inclination: quantities, channels, powers. */
typedef struct hairis_dual { float coefficients[8][3][10]; } hairis_dual;
/* Light after the fibres between it and a hit, as shares of what it was; shift and variance of its inclination in rad and rad^2. */
typedef struct hairis_crossed { float direct, scattered[3], shift[3], variance[3]; } hairis_crossed;

/* Outputs. Columns that are NULL are not written; over hits, the three columns of one vector are either all NULL or all given. */
typedef struct hairis_evals { float *value[3], *pdf; } hairis_evals;
/* lobe: slot of the lobe as a number, -1 for a discarded sample. The value, pdf and weight of a discarded sample are 0; its wi may be
 * anything, but is 0 if no column other than wi is given. */
typedef struct hairis_samples { float *wi[3], *value[3], *pdf, *weight[3], *lobe; } hairis_samples;
typedef struct hairis_hits {
  const float *wo[3];
  const float *h;        /* offset across the fibre; NULL stands for 0 everywhere */
  const uint32_t *index; /* index of each hit's material; NULL stands for 0 everywhere */
} hairis_hits;
typedef struct hairis_candidates { const float *wi[3], *radiance[3], *pdf_light; } hairis_candidates;
typedef struct hairis_weights { float *contribution[3], *weight; } hairis_weights;
/* Counts of the candidates drawn from the BSDF and from the light, and one of HAIRIS_PARTITION_. */
typedef struct hairis_counts { uint32_t bsdf, light, partition; } hairis_counts;
typedef struct hairis_choice { size_t index; uint32_t count; float contribution[3]; } hairis_choice;

/* The library. A host compares hairis_abi_version() with HAIRIS_ABI_VERSION once. level_name writes the name of the instruction set
 * that calls run on, for reports: like snprintf, it writes at most size - 1 characters and a 0, and returns the length of the name. */
uint32_t hairis_abi_version(void);
const char *hairis_version(void);
size_t hairis_level_name(char *to, size_t size);

/* Models, their fields and presets, by index from 0. Store names in files, because indices may change with the library. */
uint32_t hairis_model_count(void);
hairis_status hairis_model_describe(uint32_t model, hairis_model_info *to);
hairis_status hairis_field_describe(uint32_t model, uint32_t field, hairis_field_info *to);
size_t hairis_preset_name(uint32_t model, uint32_t preset, char *to, size_t size); /* 0 if there is none */

/* Parameters. init writes the parameters of a preset, or the defaults if preset is NULL. The entry is the one with the word choice, or
 * the first of the name if choice is NULL. Setting a field clears the fields that it takes the place of. hairis_material_init checks
 * the ranges. */
hairis_status hairis_params_init(hairis_params *to, const char *model, const char *choice, const char *preset,
                                 hairis_error *error);
hairis_status hairis_params_set(hairis_params *params, const char *field, const float *numbers, size_t count,
                                hairis_error *error);
hairis_status hairis_params_set_word(hairis_params *params, const char *field, const char *word, hairis_error *error);
/* Initialises parameters of chiang in the terms of another renderer, with its defaults: "cycles", "materialx", "osl", "pbrt",
 * "mitsuba" or "rtxcr". hairis_params_set and hairis_params_set_word then take that renderer's names, which hairis_field_describe lists
 * for the index in to->model. hairis_material_init converts, and refuses what is outside the range of either. */
hairis_status hairis_params_like(hairis_params *to, const char *renderer, hairis_error *error);
/* Sets the absorption of chiang or d-eon, or the intensities of TT and TRT of gaussian or cauchy, with which hair shows a colour, linear
 * RGB. of is "mass" (hair of a head), "fibre" (one fibre from its side), both under uniform light, or "chiang" (the published fit of
 * chiang). A colour that such hair cannot show becomes the nearest that it can. Set widths before. Another renderer's parameters become
 * those of chiang. Takes a tenth of a second for a mass. */
hairis_status hairis_params_set_color(hairis_params *params, const float color[3], const char *of, hairis_error *error);
void hairis_artist_init(hairis_artist *to);
hairis_status hairis_params_set_artist(hairis_params *params, const hairis_artist *from, hairis_error *error);

/* Functions called once per material. energy is one of HAIRIS_ENERGY_. */
hairis_status hairis_material_init(hairis_material *to, const hairis_params *params, uint32_t energy, hairis_error *error);
/* Returns the largest directional albedo without the factor of HAIRIS_ENERGY_CONSERVING. Above 1, the material returns more light
 * than arrives. The search takes 0.1 ms. */
float hairis_material_max_albedo(const hairis_material *material);

/* Dual scattering, for renderers that follow no paths. hairis_dual_init measures a material, in tens of milliseconds. strands returns
 * light that crossed count fibres with these averages, which lie at the inclination theta_i (rad) to it; depth, light that came through
 * an optical depth, the mean number of such fibres. through adds one fibre to light that begins with direct = 1 and zeros else. shade
 * writes light from wi to the viewer in place of S (single), by one scattering and by those of other fibres; gain is
 * { HAIRIS_DUAL_GAIN, HAIRIS_DUAL_GAIN }, or 0 for light that crossed fibres or that comes back from those behind. */
#define HAIRIS_DUAL_GAIN 1.15f
hairis_status hairis_dual_init(hairis_dual *to, const hairis_material *material);
hairis_crossed hairis_dual_strands(const hairis_dual *dual, float theta_i, float count);
hairis_crossed hairis_dual_depth(const hairis_dual *dual, float theta_i, float depth);
void hairis_dual_through(hairis_crossed *crossed, const hairis_dual *dual, float theta_i);
void hairis_dual_shade(const hairis_dual *dual, const float wo[3], const float wi[3], const float single[3],
                       const hairis_crossed *crossed, const float gain[2], float value[3]);

/* Functions called once per hit. frame writes the rows u, v and w; without a normal, v and w depend on the tangent alone. offset
 * returns the h of a hit with this outward normal, with all arguments in world space. prepare takes wo and h; far-field models ignore
 * the h. restrict keeps lobe i if bit i is set; the other lobes neither scatter nor are sampled. albedo writes the albedo of each
 * lobe, linear RGB. */
void hairis_frame(const float tangent[3], const float normal[3] /* or NULL */, float to[9]);
float hairis_offset(const float frame[9], const float normal[3], const float wo[3]);
void hairis_prepare(hairis_bsdf *to, const hairis_material *material, float u, float v, float w, float h);
void hairis_restrict(hairis_bsdf *bsdf, uint32_t lobes);
void hairis_albedo(const hairis_bsdf *bsdf, float to[HAIRIS_LOBES][3]);

/* Functions on one direction. The xi are uniform numbers in [0, 1). */
hairis_eval_result hairis_eval_pdf(const hairis_bsdf *bsdf, float u, float v, float w);
void hairis_lobes(const hairis_bsdf *bsdf, float u, float v, float w, hairis_lobe_result to[HAIRIS_LOBES]);
hairis_sample_result hairis_sample(const hairis_bsdf *bsdf, float xi_lobe, float xi_theta, float xi_phi);

/* Functions on n directions at one hit. */
hairis_status hairis_eval_columns(const hairis_bsdf *bsdf, size_t n, const float *const wi[3], const hairis_evals *to);
hairis_status hairis_sample_columns(const hairis_bsdf *bsdf, size_t n, const float *const xi[3], const hairis_samples *to);

/* Functions on one direction at each of n hits, on count materials of any models. Sort the hits by material, because eight consecutive
 * hits on one material run without packing. */
hairis_status hairis_eval_hits(const hairis_material *materials, size_t count, size_t n, const hairis_hits *hits,
                               const float *const wi[3], const hairis_evals *to);
hairis_status hairis_sample_hits(const hairis_material *materials, size_t count, size_t n, const hairis_hits *hits,
                                 const float *const xi[3], const hairis_samples *to);

/* One ray for many candidates of one hit. The host draws candidates from the BSDF (hairis_sample_columns with wi alone) and from its
 * light, looks up the radiance and the light's density for all of them, and weighs them. choose picks k candidates by one number u in
 * [0, 1), with probability proportional to their weights. It returns the number of choices that it wrote, which is at most k because
 * equal choices share one ray. The sum of visibility * contribution over the choices is the light. */
hairis_status hairis_weigh_columns(const hairis_bsdf *bsdf, size_t n, const hairis_candidates *candidates,
                                   hairis_counts counts, const hairis_weights *to);
size_t hairis_choose(const hairis_weights *from, size_t n, uint32_t k, float u, hairis_choice *to);

#ifdef __cplusplus
}
#endif
#endif
