/* Elementary functions from correctly rounded operations, and poses. */
#include "grrl/base/geometry.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* The polynomials are those of the Cephes library (Moshier), minimax on the reduced ranges. */

/* Beyond this the reduced angle has too few correct digits to be useful. */
#define MAX_ANGLE_RAD 8192.0f

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static float absolute(float x)
{
    return x < 0.0f ? -x : x;
}

static int nearest_int(float x)
{
    return (int)(x < 0.0f ? x - 0.5f : x + 0.5f);
}

/*
 * Returns angle - k pi/2 for the nearest k, in [-pi/4, pi/4]. pi/2 is split into three parts; the
 * first has 8 significant bits, so its product with k is exact.
 */
static float reduce_quarter(float angle_rad, unsigned *quadrant)
{
    int k = nearest_int(angle_rad * (2.0f / GRRL_PI));
    float turns = (float)k;
    *quadrant = (unsigned)k & 3u;
    return ((angle_rad - turns * 1.5703125f) - turns * 4.837512969970703e-4f) -
           turns * 7.549789948768648e-8f;
}

static float sin_polynomial(float x)
{
    float z = x * x;
    return x + x * z * ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f);
}

static float cos_polynomial(float x)
{
    float z = x * x;
    float tail = (2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f;
    return 1.0f - 0.5f * z + z * z * tail;
}

/* sin(angle + shift pi/2) */
static float sin_shifted(float angle_rad, unsigned shift)
{
    if (!(absolute(angle_rad) <= MAX_ANGLE_RAD))
        return NAN;
    unsigned quadrant;
    float x = reduce_quarter(angle_rad, &quadrant);
    quadrant = (quadrant + shift) & 3u;
    float value = (quadrant & 1u) != 0u ? cos_polynomial(x) : sin_polynomial(x);
    return (quadrant & 2u) != 0u ? -value : value;
}

float grrl_sin(float angle_rad)
{
    return sin_shifted(angle_rad, 0);
}

float grrl_cos(float angle_rad)
{
    return sin_shifted(angle_rad, 1);
}

/* For x in [0, 1]. */
static float atan_unit(float x)
{
    float offset = 0.0f;
    if (x > 0.41421356f) { /* tan(pi/8): atan x = pi/4 + atan((x - 1) / (x + 1)) */
        offset = 0.25f * GRRL_PI;
        x = (x - 1.0f) / (x + 1.0f);
    }
    float z = x * x;
    float tail = ((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                 3.33329491539e-1f;
    return offset + (x + x * z * tail);
}

float grrl_atan2(float y, float x)
{
    float ax = absolute(x);
    float ay = absolute(y);
    if (ax == 0.0f && ay == 0.0f)
        return 0.0f;
    float angle = ay <= ax ? atan_unit(ay / ax) : 0.5f * GRRL_PI - atan_unit(ax / ay);
    if (x < 0.0f)
        angle = GRRL_PI - angle;
    return y < 0.0f ? -angle : angle;
}

float grrl_exp(float x)
{
    if (x > 88.72283f) /* log(FLT_MAX) */
        return FLT_MAX;
    if (x < -87.33654f) /* log(FLT_MIN) */
        return 0.0f;
    if (x != x)
        return x;
    int n = nearest_int(x * 1.44269504f);
    float whole = (float)n;
    float r = (x - whole * 0.693359375f) + whole * 2.12194440e-4f; /* log 2 in two parts */
    float p = 1.9875691500e-4f;
    p = p * r + 1.3981999507e-3f;
    p = p * r + 8.3334519073e-3f;
    p = p * r + 4.1665795894e-2f;
    p = p * r + 1.6666665459e-1f;
    p = p * r + 5.0000001201e-1f;
    float value = 1.0f + (r + r * r * p);
    int half = n / 2; /* 2^n as two factors: n may be 128, and 2^128 is no float */
    return value * float_of((uint32_t)(127 + half) << 23) *
           float_of((uint32_t)(127 + n - half) << 23);
}

/* x = m 2^e with m in [sqrt(1/2), sqrt(2)), for finite x > 0. */
static float split(float x, int *e)
{
    int exponent = 0;
    if (x < FLT_MIN) {
        x *= 33554432.0f;
        exponent = -25;
    }
    uint32_t bits = bits_of(x);
    exponent += (int)(bits >> 23) - 126;
    float m = float_of((bits & UINT32_C(0x007fffff)) | UINT32_C(0x3f000000));
    if (m < 0.70710678f) {
        m *= 2.0f;
        --exponent;
    }
    *e = exponent;
    return m;
}

float grrl_log(float x)
{
    if (x <= 0.0f)
        return -FLT_MAX;
    if (!grrl_is_finite(x))
        return x;
    int e;
    float m = split(x, &e) - 1.0f;
    float z = m * m;
    float p = 7.0376836292e-2f;
    p = p * m - 1.1514610310e-1f;
    p = p * m + 1.1676998740e-1f;
    p = p * m - 1.2420140846e-1f;
    p = p * m + 1.4249322787e-1f;
    p = p * m - 1.6668057665e-1f;
    p = p * m + 2.0000714765e-1f;
    p = p * m - 2.4999993993e-1f;
    p = p * m + 3.3333331174e-1f;
    float tail = p * m * z;
    float whole = (float)e;
    tail += -2.12194440e-4f * whole;
    tail -= 0.5f * z;
    return (m + tail) + 0.693359375f * whole;
}

float grrl_sqrt(float x)
{
    return sqrtf(x);
}

bool grrl_is_finite(float x)
{
    return (bits_of(x) & UINT32_C(0x7f800000)) != UINT32_C(0x7f800000);
}

float grrl_wrap_rad(float angle_rad)
{
    if (!(absolute(angle_rad) <= MAX_ANGLE_RAD))
        return NAN;
    if (angle_rad > -GRRL_PI && angle_rad <= GRRL_PI)
        return angle_rad;
    float turns = (float)nearest_int(angle_rad * (0.5f / GRRL_PI));
    float wrapped = ((angle_rad - turns * 6.28125f) - turns * 1.9350051879882812e-3f) -
                    turns * 3.0199159795e-7f;
    if (wrapped > GRRL_PI)
        wrapped -= 2.0f * GRRL_PI;
    else if (wrapped <= -GRRL_PI)
        wrapped += 2.0f * GRRL_PI;
    return wrapped;
}

void grrl_principal_axes(float xx, float xy, float yy, float *major, float *minor,
                         struct grrl_vec2 *axis)
{
    float scale = absolute(xx);
    scale = absolute(xy) > scale ? absolute(xy) : scale;
    scale = absolute(yy) > scale ? absolute(yy) : scale;
    *axis = (struct grrl_vec2){1.0f, 0.0f};
    if (!(scale >= FLT_MIN) || !grrl_is_finite(scale)) {
        *major = xx > yy ? xx : yy;
        *minor = xx > yy ? yy : xx;
        return;
    }
    float a = xx / scale; /* the squares below neither overflow nor underflow */
    float b = xy / scale;
    float d = yy / scale;
    float mean = 0.5f * (a + d);
    float half = 0.5f * (a - d);
    float root = grrl_sqrt(half * half + b * b);
    *major = scale * (mean + root);
    *minor = scale * (mean - root);
    if (root > 0.0f) {
        /* Takes the row of (matrix - minor) that has no cancellation. */
        struct grrl_vec2 v =
            half >= 0.0f ? (struct grrl_vec2){half + root, b} : (struct grrl_vec2){b, root - half};
        *axis = grrl_vec2_scale(v, 1.0f / grrl_vec2_length(v));
    }
    if (axis->x < 0.0f)
        *axis = (struct grrl_vec2){-axis->x, -axis->y};
    if (axis->x == 0.0f)
        *axis = (struct grrl_vec2){0.0f, 1.0f};
}
