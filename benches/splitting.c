/* The symplectic splittings in plain C, by the same algorithm: the yardstick of benches/against_c.rs.
 *
 * A heavy top (I1 = 8.35, I3 = 3.2 kg m^2, mgl = 63.7 N m, tilt 45 degrees, L = 100 J s) at dt = 1/60 s. Every stage turns
 * axle and side about L; the spin about the axle is applied once per step. Sine and cosine of small angles use series.
 * Prints nanoseconds per step.   Usage: splitting strang|srkn11b STEPS
 */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    double q[3][3], l[3]; /* q[j]: column j */
} State;

static double across, excess, force; /* 1/I1, 1/I3 - 1/I1, vertical force times its height on the axle */

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double *a, const double *b, double *c) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* sin(t)/t and (1 - cos t)/t^2 of z = t^2 */
static void factors(double z, double *s, double *c) {
    if (z > 2.0) {
        double t = sqrt(z), si, co;
        sincos(t, &si, &co);
        *s = si / t, *c = (1 - co) / z;
        return;
    }
    double zz = z * z, z4 = zz * zz;
    double a = (-0.1666666666666657 + 0.008333333333321188 * z) + zz * (-0.0001984126983603416 + 2.75573181536637e-6 * z);
    double b = (-2.5051991317864326e-8 + 1.6052000857008033e-10 * z) - 7.427069524982516e-13 * zz;
    double d = (-0.041666666666666616 + 0.0013888888888882313 * z) + zz * (-2.480158729872942e-5 + 2.755731863649858e-7 * z);
    double e = (-2.087669245587818e-9 + 1.1466849765275946e-11 * z) - 4.657392265163401e-14 * zz;
    *s = 1.0 + z * (a + z4 * b), *c = 0.5 + z * (d + z4 * e);
}

static void rotate(const double *w, double s, double c, double *v) {
    double a[3], b[3];
    cross(w, v, a);
    cross(w, a, b);
    for (int i = 0; i < 3; i++) v[i] += s * a[i] + c * b[i];
}

static void step(State *x, const double (*stages)[2], int n, double h) {
    double axle[3], side[3], l[3], si, co;
    memcpy(axle, x->q[2], sizeof axle);
    memcpy(l, x->l, sizeof l);
    sincos(excess * dot(axle, l) * h, &si, &co);
    for (int i = 0; i < 3; i++) side[i] = x->q[0][i] * co + x->q[1][i] * si;
    double unit = 1.5 - 0.5 * dot(axle, axle);
    for (int k = 0; k < n; k++) {
        double f = force * (stages[k][0] * h), t = across * (stages[k][1] * h), w[3], s, c;
        l[0] += axle[1] * f, l[1] -= axle[0] * f;
        for (int i = 0; i < 3; i++) w[i] = l[i] * t;
        factors(dot(w, w), &s, &c);
        rotate(w, s, c, axle);
        rotate(w, s, c, side);
    }
    for (int i = 0; i < 3; i++) axle[i] *= unit;
    double f = force * (stages[0][0] * h), d = dot(axle, side);
    l[0] += axle[1] * f, l[1] -= axle[0] * f;
    for (int i = 0; i < 3; i++) side[i] -= axle[i] * d;
    double u = 1.5 - 0.5 * dot(side, side);
    for (int i = 0; i < 3; i++) x->q[0][i] = side[i] * u;
    memcpy(x->q[2], axle, sizeof axle);
    memcpy(x->l, l, sizeof l);
    cross(x->q[2], x->q[0], x->q[1]);
}

/* Blanes & Moan (2002), table 3 */
#define B1 0.0414649985182624
#define B2 0.198128671918067
#define B3 (-0.0400061921041533)
#define B4 0.0752539843015807
#define B5 (-0.0115113874206879)
#define B6 (0.5 - (B1 + B2 + B3 + B4 + B5))
#define A1 0.123229775946271
#define A2 0.290553797799558
#define A3 (-0.127049212625417)
#define A4 (-0.246331761062075)
#define A5 0.357208872795928
#define A6 (1.0 - 2.0 * (A1 + A2 + A3 + A4 + A5))
static const double strang[1][2] = {{0.5, 1.0}};
static const double srkn11b[11][2] = {{B1, A1}, {B2, A2}, {B3, A3}, {B4, A4}, {B5, A5}, {B6, A6},
                                      {B6, A5}, {B5, A4}, {B4, A3}, {B3, A2}, {B2, A1}};

int main(int argc, char **argv) {
    int simple = argc > 1 && !strcmp(argv[1], "strang");
    long steps = argc > 2 ? atol(argv[2]) : 100000;
    double c = sqrt(0.5);
    across = 1 / 8.35, excess = 1 / 3.2 - across, force = -63.7;
    State x = {{{1, 0, 0}, {0, c, c}, {0, -c, c}}, {0, -100 * c, 100 * c}};
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (long k = 0; k < steps; k++) {
        if (simple) step(&x, strang, 1, 1.0 / 60);
        else step(&x, srkn11b, 11, 1.0 / 60);
        __asm__ volatile("" : : "r"(&x) : "memory");
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    double ns = (end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec);
    fprintf(stderr, "%.17g %.17g %.17g\n", x.q[2][0], x.q[2][1], x.q[2][2]);
    printf("%.3f\n", ns / steps);
    return 0;
}
