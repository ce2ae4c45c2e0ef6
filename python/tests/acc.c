/* A cruise controller as an FMU for co-simulation, of FMI 2 or 3: it keeps a speed, and brakes for a body ahead. */
#include <stdlib.h>
#include <string.h>

typedef struct {
    double value[8];
} Car;

enum { SPEED, CRUISE, LEAD, OFFSET, THROTTLE, STEERING, GAIN, STEPS };

#define E __attribute__((visibility("default")))
typedef const char *text;
typedef unsigned int ref;

static void *made(text guid) {
    if (strcmp(guid, "{acc}") != 0) return NULL;
    Car *car = calloc(1, sizeof(Car));
    car->value[GAIN] = 0.2;
    return car;
}

static int get(void *c, const ref *r, size_t n, double *value) {
    for (size_t i = 0; i < n; i++) value[i] = ((Car *)c)->value[r[i]];
    return 0;
}

static int set(void *c, const ref *r, size_t n, const double *value) {
    for (size_t i = 0; i < n; i++) ((Car *)c)->value[r[i]] = value[i];
    return 0;
}

static int step(void *c) {
    double *v = ((Car *)c)->value;
    double throttle = v[GAIN] * (v[CRUISE] - v[SPEED]);
    if (v[LEAD] < 2.0 * v[SPEED]) throttle = -1.0;
    v[THROTTLE] = throttle > 1.0 ? 1.0 : throttle < -1.0 ? -1.0 : throttle;
    v[STEERING] = -0.05 * v[OFFSET];
    v[STEPS] += 1.0;
    /* A test asks for an error by a negative gain. */
    return v[GAIN] < 0.0 && v[STEPS] > 3.0 ? 3 : 0;
}

/* The test adds the other functions of the standard, which nobody calls. */
#ifdef FMI3
E text fmi3GetVersion(void) { return "3.0"; }
E void *fmi3InstantiateCoSimulation(text name, text token, text resources, _Bool visible, _Bool logging, _Bool events, _Bool early,
                                    const ref *required, size_t n, void *environment, void *log, void *update) {
    return made(token);
}
E void fmi3FreeInstance(void *c) { free(c); }
E int fmi3EnterInitializationMode(void *c, _Bool t, double tolerance, double start, _Bool s, double stop) { return 0; }
E int fmi3ExitInitializationMode(void *c) { return 0; }
E int fmi3Terminate(void *c) { return 0; }
E int fmi3GetFloat64(void *c, const ref *r, size_t n, double *value, size_t m) { return get(c, r, n, value); }
E int fmi3SetFloat64(void *c, const ref *r, size_t n, const double *value, size_t m) { return set(c, r, n, value); }
E int fmi3DoStep(void *c, double time, double size, _Bool no, _Bool *event, _Bool *over, _Bool *early, double *last) {
    *event = *over = *early = 0;
    *last = time + size;
    return step(c);
}
#else
E text fmi2GetTypesPlatform(void) { return "default"; }
E text fmi2GetVersion(void) { return "2.0"; }
E void *fmi2Instantiate(text name, int type, text guid, text resources, const void *functions, int visible, int logging) { return made(guid); }
E void fmi2FreeInstance(void *c) { free(c); }
E int fmi2SetupExperiment(void *c, int t, double tolerance, double start, int s, double stop) { return 0; }
E int fmi2EnterInitializationMode(void *c) { return 0; }
E int fmi2ExitInitializationMode(void *c) { return 0; }
E int fmi2Terminate(void *c) { return 0; }
E int fmi2GetReal(void *c, const ref *r, size_t n, double *value) { return get(c, r, n, value); }
E int fmi2SetReal(void *c, const ref *r, size_t n, const double *value) { return set(c, r, n, value); }
E int fmi2DoStep(void *c, double time, double size, int no) { return step(c); }
#endif
