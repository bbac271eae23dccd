/* Infers the parameters of measurements by a trained map.
 *
 * Usage: infer RUN MEASUREMENT...          RUN: the folder of a finished run, or its maps.h5
 * Build: cc -std=c99 infer.c $(pkg-config --cflags --libs twinmap) -o infer
 */
#include <stdio.h>
#include <stdlib.h>
#include <twinmap.h>

static int fail(const char* what) {
  fprintf(stderr, "%s: %s\n", what, twinmap_get_error());
  return EXIT_FAILURE;
}

static void print_statuses(const twinmap_inferrer* inferrer) {
  size_t i;
  for (i = 0; i < twinmap_count_statuses(inferrer); ++i) {
    printf(" %s", twinmap_get_status(inferrer, i));
  }
  printf(" (p = %.3g)\n", twinmap_get_number(inferrer, TWINMAP_P_VALUE));
}

static int print_answer(const twinmap_map* map, const twinmap_inferrer* inferrer) {
  const size_t count = twinmap_count_parameters(map);
  double* mean = malloc(count * sizeof *mean);
  double* stddev = malloc(count * sizeof *stddev);
  twinmap_quantity parameter;
  size_t i;
  int done = mean != NULL && stddev != NULL && twinmap_get_mean(inferrer, mean, count) == TWINMAP_OK &&
             twinmap_get_stddev(inferrer, stddev, count) == TWINMAP_OK;
  for (i = 0; done && i < count; ++i) {
    done = twinmap_get_parameter(map, i, &parameter) == TWINMAP_OK;
    printf("  %-10s %12.6g +- %-10.3g %s\n", parameter.name, mean[i], stddev[i], parameter.unit);
  }
  free(mean);
  free(stddev);
  return done;
}

static int infer(const twinmap_map* map, int count, char** files) {
  twinmap_inferrer* inferrer = NULL;
  int i, result = EXIT_SUCCESS;
  if (twinmap_new_inferrer(map, TWINMAP_REFINE_NEVER, &inferrer) != TWINMAP_OK) {
    return fail("inferrer");
  }
  for (i = 0; i < count; ++i) {
    if (twinmap_infer_file(inferrer, files[i]) != TWINMAP_OK) {
      result = fail(files[i]);
      continue;
    }
    printf("%s:", files[i]);
    print_statuses(inferrer);
    if (!print_answer(map, inferrer)) {
      result = fail(files[i]);
    }
  }
  twinmap_close_inferrer(inferrer);
  return result;
}

int main(int count, char** arguments) {
  twinmap_map* map = NULL;
  int result;
  if (count < 3) {
    fprintf(stderr, "usage: %s RUN MEASUREMENT...\n", arguments[0]);
    return 2;
  }
  if (twinmap_open(arguments[1], &map) != TWINMAP_OK) {
    return fail(arguments[1]);
  }
  result = infer(map, count - 2, arguments + 2);
  twinmap_close(map);
  return result;
}
