"""Time of an inference by exported C against the library's own (provenance.json of the run), both with the trust status.

Usage: bench/exported_c.py TWINMAP EXPERIMENT.yaml [override]...
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

LOOP = r"""
#define _POSIX_C_SOURCE 200809L
#define main selftest_main
#include "selftest.c"
#undef main
#include <stdlib.h>
#include <time.h>

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
  return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

int main(void)
{
  static double times[MEASUREMENTS * 20];
  int count = 0, i, k;
  for (k = 0; k < 20; ++k) {
    for (i = 0; i < MEASUREMENTS; ++i) {
      if (expected_statuses[i] % 16 == 0) { /* what a machine gives that is as the model says */
        twinmap_result result;
        const double begin = now();
        infer(i, &result);
        times[count++] = now() - begin;
      }
    }
  }
  qsort(times, (size_t)count, sizeof times[0], compare);
  printf("%.3f %.3f\n", 1e6 * times[count / 2], 1e6 * times[count - 1 - count / 100]);
  return 0;
}
"""


def main():
    twinmap, experiment, *overrides = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        subprocess.run(
            [twinmap, "run", experiment, *overrides, "--out", folder / "run", "--quiet"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        subprocess.run([twinmap, "export", folder / "run", "--c", folder / "c"], check=True, stdout=subprocess.DEVNULL)
        (folder / "c/loop.c").write_text(LOOP)
        library = json.loads((folder / "run/provenance.json").read_text())
        online = next(value for value in library.values() if isinstance(value, dict) and "median_us" in value)
        print(f"{Path(experiment).stem}: twinmap {online['median_us']:.0f} us (median)")
        for compiler, flags in [("gcc", "-O3 -march=native"), ("gcc", "-O2"), ("clang", "-O3 -march=native")]:
            subprocess.run(
                [compiler, "-std=c99", *flags.split(), "loop.c", "twinmap_map.c", "-o", "loop", "-lm"],
                cwd=folder / "c",
                check=True,
            )
            median, late = map(
                float, subprocess.run([folder / "c/loop"], capture_output=True, text=True, check=True).stdout.split()
            )
            print(
                f"  {compiler} {flags}: {median:.0f} us, {median / online['median_us']:.2f} times; 99 % {late:.0f} us"
            )


if __name__ == "__main__":
    main()
