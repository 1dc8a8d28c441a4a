/* The report's scheme in plain C: the yardstick of benches/against_c.rs.
 *
 * Ten rim points, four axle points, and the start and time step of method-2. Like the Rust stepper, every step stores its
 * record (state before, inertia, Omega, rotation, torque, state after). Prints nanoseconds per step.
 * Usage: report_step STEPS [POINTS]   (POINTS: number of rim points, 10 by default)
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    double t, q[3][3], l[3];
} State;

typedef struct {
    long step;
    double dt;
    State before;
    double inertia[3][3], omega[3], rotation[3][3], torque[3];
    State after;
} Record;

static double (*X)[3], (*F)[3], *m;
static int n;

static void inertia_about_pivot(double I[3][3]) {
    memset(I, 0, 9 * sizeof(double));
    for (int k = 0; k < n; k++) {
        double r2 = X[k][0] * X[k][0] + X[k][1] * X[k][1] + X[k][2] * X[k][2];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                I[i][j] += m[k] * ((i == j ? r2 : 0.0) - X[k][i] * X[k][j]);
    }
}

static void solve(double I[3][3], const double b[3], double x[3]) {
    double a[3][4];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) a[i][j] = I[i][j];
        a[i][3] = b[i];
    }
    for (int i = 0; i < 3; i++)
        for (int k = i + 1; k < 3; k++) {
            double f = a[k][i] / a[i][i];
            for (int j = i; j < 4; j++) a[k][j] -= f * a[i][j];
        }
    for (int i = 2; i >= 0; i--) {
        x[i] = a[i][3];
        for (int j = i + 1; j < 3; j++) x[i] -= a[i][j] * x[j];
        x[i] /= a[i][i];
    }
}

static void rotation_by(const double w[3], double dt, double R[3][3]) {
    double len = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) R[i][j] = i == j;
    if (len == 0) return;
    double u[3] = {w[0] / len, w[1] / len, w[2] / len};
    double s = sin(len * dt), c = cos(len * dt);
    double C[3][3] = {{0, -u[2], u[1]}, {u[2], 0, -u[0]}, {-u[1], u[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double P = u[i] * u[j];
            R[i][j] = P + c * ((i == j) - P) + s * C[i][j];
        }
}

static void step(State *state, long number, double dt, Record *r) {
    r->step = number;
    r->dt = dt;
    r->before = *state;
    inertia_about_pivot(r->inertia);
    solve(r->inertia, state->l, r->omega);
    rotation_by(r->omega, dt, r->rotation);
    for (int k = 0; k < n; k++) {
        double y[3];
        for (int i = 0; i < 3; i++)
            y[i] = r->rotation[i][0] * X[k][0] + r->rotation[i][1] * X[k][1] + r->rotation[i][2] * X[k][2];
        memcpy(X[k], y, sizeof y);
    }
    double Q[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            Q[i][j] = r->rotation[i][0] * state->q[0][j] + r->rotation[i][1] * state->q[1][j] +
                      r->rotation[i][2] * state->q[2][j];
    memcpy(state->q, Q, sizeof Q);
    memset(r->torque, 0, sizeof r->torque);
    for (int k = 0; k < n; k++) {
        r->torque[0] += X[k][1] * F[k][2] - X[k][2] * F[k][1];
        r->torque[1] += X[k][2] * F[k][0] - X[k][0] * F[k][2];
        r->torque[2] += X[k][0] * F[k][1] - X[k][1] * F[k][0];
    }
    for (int i = 0; i < 3; i++) state->l[i] += dt * r->torque[i];
    state->t = number * dt;
    r->after = *state;
}

int main(int argc, char **argv) {
    long steps = argc > 1 ? atol(argv[1]) : 1000000;
    int rim = argc > 2 ? atoi(argv[2]) : 10;
    double h = 0.8 / sqrt(2.0), dt = 0.1, pi = acos(-1.0), c = cos(pi / 4), s = sin(pi / 4);
    n = rim + 4;
    X = calloc(n, sizeof *X);
    F = calloc(n, sizeof *F);
    m = calloc(n, sizeof *m);
    if (!X || !F || !m) return 1;
    double axle[4] = {h, 2 * h, 0, h / 2};
    for (int k = 0; k < n; k++) {
        double a = 2 * pi * k / rim, on_rim = k < rim;
        double x = on_rim ? 0.8 * cos(a) : 0, y = on_rim ? 0.8 * sin(a) : 0, z = on_rim ? h : axle[k - rim];
        m[k] = on_rim ? 5.0 / rim : 0;
        X[k][0] = x, X[k][1] = c * y - s * z, X[k][2] = s * y + c * z;
        F[k][2] = -9.8 * m[k];
    }
    State state = {0, {{1, 0, 0}, {0, c, -s}, {0, s, c}}, {0, -s * 1000, c * 1000}};
    Record record;
    double sink = 0;
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (long k = 1; k <= steps; k++) {
        step(&state, k, dt, &record);
        sink += record.torque[0];
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    double ns = (end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec);
    fprintf(stderr, "%.17g %.17g\n", X[rim + 1][2], sink);
    printf("%.3f\n", ns / steps);
    return 0;
}
