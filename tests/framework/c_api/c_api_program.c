/* Uses libtwinmap as a program in C does, and says what is not as twinmap.h promises.
 *
 * c_api_program check MAPS MEASUREMENT     everything that can be told without another program
 * c_api_program json MAPS REFINE MEASUREMENT...   a line of JSON each, or "error: ..."
 * c_api_program posterior EXPERIMENT MEASUREMENT   inference without a map
 * c_api_program threads MAPS MEASUREMENT   the same answer in four threads at once
 */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <twinmap.h>

#define MOST 512 /* features, parameters squared */
#define ROWS 3

static int failures = 0;

#define EXPECT(condition)                                                        \
  do {                                                                           \
    if (!(condition)) {                                                          \
      fprintf(stderr, "%s:%d: not true: %s (last error: %s)\n", __FILE__, __LINE__, #condition, \
              twinmap_get_error());                                              \
      ++failures;                                                                \
    }                                                                            \
  } while (0)

#define EXPECT_WRONG(call, text)                            \
  do {                                                      \
    EXPECT((call) == TWINMAP_WRONG_INPUT);                  \
    EXPECT(strstr(twinmap_get_error(), (text)) != NULL);    \
  } while (0)

static void check_opening(const char* maps) {
  twinmap_map* map = NULL;
  EXPECT(strcmp(twinmap_get_error(), "") == 0);
  EXPECT(twinmap_open("no/such/folder", &map) == TWINMAP_FAILED);
  EXPECT(map == NULL);
  EXPECT(strstr(twinmap_get_error(), "no/such/folder") != NULL);
  EXPECT_WRONG(twinmap_open(NULL, &map), "run_or_maps");
  EXPECT_WRONG(twinmap_open(maps, NULL), "map");
  EXPECT(strlen(twinmap_get_version()) > 0);
  twinmap_close(NULL);
  twinmap_close_inferrer(NULL);
}

static void check_quantities(const twinmap_map* map) {
  twinmap_quantity quantity;
  EXPECT(twinmap_count_parameters(map) == 4);
  EXPECT(twinmap_count_features(map) == 200);
  EXPECT(twinmap_count_outputs(map) == 2);
  EXPECT(twinmap_count_inputs(map) == 0);
  EXPECT(twinmap_count_parameters(NULL) == 0);
  EXPECT(twinmap_get_parameter(map, 2, &quantity) == TWINMAP_OK);
  EXPECT(strcmp(quantity.name, "k_y") == 0 && strcmp(quantity.unit, "N/m") == 0);
  EXPECT(quantity.lower == 5.0 && quantity.upper == 15.0);
  EXPECT(twinmap_get_feature(map, 0, &quantity) == TWINMAP_OK);
  EXPECT(strcmp(quantity.name, "y(0.05 s)") == 0 && isnan(quantity.lower));
  EXPECT(twinmap_get_output(map, 1, &quantity) == TWINMAP_OK && strcmp(quantity.name, "theta") == 0);
  EXPECT_WRONG(twinmap_get_parameter(map, 4, &quantity), "parameter 4: there are 4");
  EXPECT_WRONG(twinmap_get_input(map, 0, &quantity), "input 0: there are 0");
  EXPECT_WRONG(twinmap_get_output(map, 0, NULL), "quantity");
}

static void check_no_answer(twinmap_inferrer* inferrer) {
  double values[4];
  EXPECT_WRONG(twinmap_get_mean(inferrer, values, 4), "no estimate");
  EXPECT(twinmap_count_statuses(inferrer) == 0 && twinmap_get_status(inferrer, 0) == NULL);
  EXPECT(isnan(twinmap_get_number(inferrer, TWINMAP_P_VALUE)));
  EXPECT(twinmap_get_json(inferrer) == NULL && !twinmap_is_refined(inferrer));
}

static void check_answer(const twinmap_inferrer* inferrer) {
  double mean[4], stddev[4], lower[4], upper[4], covariance[16];
  int i, j;
  EXPECT(twinmap_get_mean(inferrer, mean, 4) == TWINMAP_OK);
  EXPECT(twinmap_get_stddev(inferrer, stddev, 4) == TWINMAP_OK);
  EXPECT(twinmap_get_interval(inferrer, lower, upper, 4) == TWINMAP_OK);
  EXPECT(twinmap_get_covariance(inferrer, covariance, 16) == TWINMAP_OK);
  for (i = 0; i < 4; ++i) {
    EXPECT(stddev[i] > 0.0 && fabs(upper[i] - lower[i] - 3.919927969 * stddev[i]) < 1e-6 * stddev[i]);
    EXPECT(fabs(0.5 * (lower[i] + upper[i]) - mean[i]) < 1e-9 * fabs(mean[i]));
    EXPECT(fabs(sqrt(covariance[5 * i]) - stddev[i]) < 1e-9 * stddev[i]);
    for (j = 0; j < i; ++j) {
      EXPECT(covariance[4 * i + j] == covariance[4 * j + i]);
    }
  }
  EXPECT_WRONG(twinmap_get_mean(inferrer, mean, 3), "must be 4");
  EXPECT_WRONG(twinmap_get_mean(inferrer, NULL, 4), "NULL");
  EXPECT(strcmp(twinmap_get_status(inferrer, 0), "ok") == 0 && twinmap_get_status(inferrer, 1) == NULL);
  EXPECT(twinmap_get_number(inferrer, TWINMAP_P_VALUE) > 0.01);
  EXPECT(twinmap_get_number(inferrer, TWINMAP_RESIDUALS) == 200.0);
  EXPECT(isnan(twinmap_get_number(inferrer, (twinmap_number)99)));
}

/** Reads t,y,theta of a CSV file; returns the number of rows. */
static size_t read_samples(const char* path, double samples[3][MOST]) {
  FILE* file = fopen(path, "r");
  char line[256];
  size_t rows = 0;
  if (file == NULL || fgets(line, sizeof line, file) == NULL) {
    return 0;
  }
  while (rows < MOST && fgets(line, sizeof line, file) != NULL &&
         sscanf(line, "%lf,%lf,%lf", &samples[0][rows], &samples[1][rows], &samples[2][rows]) == 3) {
    ++rows;
  }
  fclose(file);
  return rows;
}

static void expect_same(const twinmap_inferrer* inferrer, const double* expected) {
  double mean[4];
  EXPECT(twinmap_get_mean(inferrer, mean, 4) == TWINMAP_OK);
  EXPECT(memcmp(mean, expected, sizeof mean) == 0);
}

static void check_columns(twinmap_inferrer* inferrer, double samples[3][MOST], size_t rows, const double* expected) {
  twinmap_column columns[4];
  const char* names[] = {"t", "y", "theta"};
  size_t i;
  for (i = 0; i < 3; ++i) {
    columns[i].name = names[i];
    columns[i].values = samples[i];
    columns[i].count = rows;
  }
  EXPECT(twinmap_infer_columns(inferrer, columns, 3) == TWINMAP_OK);
  expect_same(inferrer, expected);
  EXPECT_WRONG(twinmap_infer_columns(inferrer, columns, 2), "theta");
  check_no_answer(inferrer);
  columns[3] = columns[2];
  EXPECT_WRONG(twinmap_infer_columns(inferrer, columns, 4), "twice");
  columns[2].values = NULL;
  EXPECT_WRONG(twinmap_infer_columns(inferrer, columns, 3), "theta");
  columns[2].name = NULL;
  EXPECT_WRONG(twinmap_infer_columns(inferrer, columns, 3), "name of a column");
}

static void check_pushed(twinmap_inferrer* inferrer, double samples[3][MOST], size_t rows, const double* expected) {
  const char* names[] = {"t", "y", "theta"};
  double row[3];
  size_t i;
  int round;
  for (round = 0; round < 2; ++round) {
    EXPECT(twinmap_begin(inferrer, names, 3) == TWINMAP_OK);
    EXPECT_WRONG(twinmap_infer_pushed(inferrer), "no samples");
    for (i = 0; i < rows; ++i) {
      row[0] = samples[0][i];
      row[1] = samples[1][i];
      row[2] = samples[2][i];
      EXPECT(twinmap_push(inferrer, row, 3) == TWINMAP_OK);
    }
    EXPECT_WRONG(twinmap_push(inferrer, row, 2), "must be 3");
    EXPECT(twinmap_infer_pushed(inferrer) == TWINMAP_OK);
    expect_same(inferrer, expected);
  }
}

/** The features of this experiment are the samples of both outputs from 0.05 s on. */
static void check_features(const twinmap_map* map, twinmap_inferrer* inferrer, double samples[3][MOST], size_t rows) {
  double features[ROWS][200], mean[ROWS][4], stddev[ROWS][4], one[4];
  size_t i, first = rows - 100;
  for (i = 0; i < ROWS; ++i) {
    memcpy(features[i], samples[1] + first, 100 * sizeof(double));
    memcpy(features[i] + 100, samples[2] + first, 100 * sizeof(double));
    features[i][0] += 1e-5 * (double)i;
  }
  EXPECT(twinmap_predict(map, features[0], NULL, ROWS, 2, mean[0], stddev[0]) == TWINMAP_OK);
  for (i = 0; i < ROWS; ++i) {
    int p;
    EXPECT(twinmap_infer_features(inferrer, features[i], 200) == TWINMAP_OK);
    EXPECT(twinmap_get_mean(inferrer, one, 4) == TWINMAP_OK);
    for (p = 0; p < 4; ++p) {
      EXPECT(one[p] == mean[i][p]);
    }
    EXPECT(twinmap_get_stddev(inferrer, one, 4) == TWINMAP_OK);
    for (p = 0; p < 4; ++p) {
      EXPECT(one[p] == stddev[i][p]);
    }
  }
  EXPECT_WRONG(twinmap_predict(map, features[0], NULL, ROWS, 0, mean[0], stddev[0]), "threads");
  EXPECT_WRONG(twinmap_predict(map, NULL, NULL, ROWS, 1, mean[0], stddev[0]), "features");
  EXPECT_WRONG(twinmap_infer_features(inferrer, features[0], 199), "must be 200");
  features[0][7] = NAN;
  EXPECT_WRONG(twinmap_infer_features(inferrer, features[0], 200), "finite");
}

static void check_inference(const twinmap_map* map, const char* measurement) {
  static double samples[3][MOST];
  const size_t rows = read_samples(measurement, samples);
  twinmap_inferrer* inferrer = NULL;
  double expected[4];
  EXPECT_WRONG(twinmap_new_inferrer(map, (twinmap_refine)7, &inferrer), "refine");
  EXPECT_WRONG(twinmap_new_inferrer(NULL, TWINMAP_REFINE_NEVER, &inferrer), "map");
  EXPECT(inferrer == NULL);
  EXPECT(twinmap_new_inferrer(map, TWINMAP_REFINE_NEVER, &inferrer) == TWINMAP_OK);
  check_no_answer(inferrer);
  EXPECT_WRONG(twinmap_infer_file(inferrer, "missing.csv"), "missing.csv");
  check_no_answer(inferrer);
  EXPECT(twinmap_infer_file(inferrer, measurement) == TWINMAP_OK);
  check_answer(inferrer);
  EXPECT(twinmap_get_mean(inferrer, expected, 4) == TWINMAP_OK);
  EXPECT(rows >= 100 && rows < MOST);
  check_columns(inferrer, samples, rows, expected);
  check_pushed(inferrer, samples, rows, expected);
  check_features(map, inferrer, samples, rows);
  EXPECT(twinmap_set_inputs(inferrer, NULL, 0) == TWINMAP_OK);
  EXPECT_WRONG(twinmap_set_inputs(inferrer, expected, 1), "must be 0");
  EXPECT_WRONG(twinmap_set_start(inferrer, NAN), "start");
  EXPECT(twinmap_set_start(inferrer, 1e6) == TWINMAP_OK);
  EXPECT_WRONG(twinmap_infer_file(inferrer, measurement), measurement);
  twinmap_close_inferrer(inferrer);
}

static int check(const char* maps, const char* measurement) {
  twinmap_map* map = NULL;
  check_opening(maps);
  EXPECT(twinmap_open(maps, &map) == TWINMAP_OK);
  if (map != NULL) {
    check_quantities(map);
    check_inference(map, measurement);
  }
  twinmap_close(map);
  return failures > 0;
}

static int print_json(const char* maps, int refine, int count, char** files) {
  twinmap_map* map = NULL;
  twinmap_inferrer* inferrer = NULL;
  int i;
  if (twinmap_open(maps, &map) != TWINMAP_OK ||
      twinmap_new_inferrer(map, (twinmap_refine)refine, &inferrer) != TWINMAP_OK) {
    fprintf(stderr, "%s\n", twinmap_get_error());
    return 1;
  }
  for (i = 0; i < count; ++i) {
    if (twinmap_infer_file(inferrer, files[i]) == TWINMAP_OK) {
      printf("%s\n", twinmap_get_json(inferrer));
    } else {
      printf("error: %s\n", twinmap_get_error());
    }
  }
  twinmap_close_inferrer(inferrer);
  twinmap_close(map);
  return 0;
}

struct job {
  const twinmap_map* map;
  const char* measurement;
  double mean[4];
  int good; /* answers, and errors where there should be one */
};

static void* infer_often(void* pointer) {
  struct job* job = pointer;
  twinmap_inferrer* inferrer = NULL;
  int i;
  if (twinmap_new_inferrer(job->map, TWINMAP_REFINE_NEVER, &inferrer) != TWINMAP_OK) {
    return NULL;
  }
  for (i = 0; i < 50; ++i) {
    const int failed = twinmap_infer_file(inferrer, "missing.csv") == TWINMAP_WRONG_INPUT &&
                       strstr(twinmap_get_error(), "missing.csv") != NULL;
    const int inferred = twinmap_infer_file(inferrer, job->measurement) == TWINMAP_OK &&
                         twinmap_get_mean(inferrer, job->mean, 4) == TWINMAP_OK;
    job->good += failed && inferred;
  }
  twinmap_close_inferrer(inferrer);
  return NULL;
}

static int infer_in_threads(const char* maps, const char* measurement) {
  enum { kThreads = 4 };
  struct job jobs[kThreads];
  pthread_t threads[kThreads];
  twinmap_map* map = NULL;
  int i;
  EXPECT(twinmap_open(maps, &map) == TWINMAP_OK);
  for (i = 0; i < kThreads; ++i) {
    memset(&jobs[i], 0, sizeof jobs[i]);
    jobs[i].map = map;
    jobs[i].measurement = measurement;
    EXPECT(pthread_create(&threads[i], NULL, infer_often, &jobs[i]) == 0);
  }
  for (i = 0; i < kThreads; ++i) {
    pthread_join(threads[i], NULL);
    EXPECT(jobs[i].good == 50);
    EXPECT(memcmp(jobs[i].mean, jobs[0].mean, sizeof jobs[0].mean) == 0);
  }
  twinmap_close(map);
  return failures > 0;
}

/** An experiment alone: two parameters, the sign of the first is not seen. */
static int check_posterior(const char* experiment, const char* measurement) {
  static double values[2 * 5000], weights[5000];
  double mean[2], lower[2], upper[2], weight = 0.0, sum = 0.0, of_draws = 0.0, middle[2] = {0.0, 0.0};
  double component[2], stddev[2];
  twinmap_map* map = NULL;
  twinmap_inferrer* inferrer = NULL;
  size_t i, draws;
  EXPECT(twinmap_open(experiment, &map) == TWINMAP_OK);
  EXPECT(twinmap_count_parameters(map) == 2);
  EXPECT_WRONG(twinmap_predict(map, values, NULL, 1, 1, mean, stddev), "no map");
  EXPECT_WRONG(twinmap_new_inferrer(map, TWINMAP_REFINE_ALWAYS, &inferrer), "nothing to refine");
  EXPECT_WRONG(twinmap_new_posterior_inferrer(map, TWINMAP_REFINE_AS_EXPERIMENT, TWINMAP_POSTERIOR_SURROGATE, 0,
                                              &inferrer), "no surrogate");
  EXPECT_WRONG(twinmap_new_posterior_inferrer(map, TWINMAP_REFINE_AS_EXPERIMENT, TWINMAP_POSTERIOR_SIMULATOR, 10,
                                              &inferrer), "at least 200 draws");
  EXPECT(twinmap_new_inferrer(map, TWINMAP_REFINE_AS_EXPERIMENT, &inferrer) == TWINMAP_OK);
  EXPECT(twinmap_count_draws(inferrer) == 0 && twinmap_count_components(inferrer) == 0);
  EXPECT(twinmap_infer_file(inferrer, measurement) == TWINMAP_OK);
  EXPECT(strcmp(twinmap_get_method(inferrer), "posterior") == 0 && !twinmap_is_refined(inferrer));
  EXPECT(strcmp(twinmap_get_status(inferrer, 0), "multimodal") == 0);
  EXPECT(twinmap_get_number(inferrer, TWINMAP_P_VALUE) > 0.01);
  EXPECT(twinmap_count_components(inferrer) == 2);
  EXPECT(twinmap_get_mean(inferrer, mean, 2) == TWINMAP_OK);
  EXPECT(twinmap_get_interval(inferrer, lower, upper, 2) == TWINMAP_OK);
  for (i = 0; i < 2; ++i) {
    EXPECT(twinmap_get_component(inferrer, i, &weight, component, stddev, 2) == TWINMAP_OK);
    EXPECT(weight > 0.3 && weight < 0.7 && fabs(fabs(component[0]) - 0.05) < 0.01 && stddev[0] < 0.01);
    middle[0] += weight * component[0];
  }
  EXPECT(fabs(middle[0] - mean[0]) < 1e-6);
  EXPECT_WRONG(twinmap_get_component(inferrer, 2, &weight, component, stddev, 2), "component 2: there are 2");
  draws = twinmap_count_draws(inferrer);
  EXPECT(draws >= 512 && draws <= 5000);
  EXPECT(twinmap_get_draws(inferrer, values, weights, draws) == TWINMAP_OK);
  for (i = 0; i < draws; ++i) {
    sum += weights[i];
    of_draws += weights[i] * values[2 * i + 1];
  }
  EXPECT(fabs(sum - 1.0) < 1e-9 && fabs(of_draws - mean[1]) < 1e-9 * mean[1]);
  EXPECT(lower[1] < mean[1] && mean[1] < upper[1]);
  twinmap_close_inferrer(inferrer);
  twinmap_close(map);
  return failures > 0;
}

int main(int count, char** arguments) {
  if (count == 4 && strcmp(arguments[1], "posterior") == 0) {
    return check_posterior(arguments[2], arguments[3]);
  }
  if (count == 4 && strcmp(arguments[1], "check") == 0) {
    return check(arguments[2], arguments[3]);
  }
  if (count == 4 && strcmp(arguments[1], "threads") == 0) {
    return infer_in_threads(arguments[2], arguments[3]);
  }
  if (count > 4 && strcmp(arguments[1], "json") == 0) {
    return print_json(arguments[2], atoi(arguments[3]), count - 4, arguments + 4);
  }
  fprintf(stderr, "usage: see c_api_program.c\n");
  return 2;
}
