#include "fmu.h"

#include <string.h>

static const double window_end = @WINDOW_END@; /* of the grid, s */
static const double input_starts[TWINMAP_SIGNALS + TWINMAP_KNOWN + 1] = {@INPUT_STARTS@};
static const double mean_starts[TWINMAP_PARAMETERS] = {@MEAN_STARTS@};
static const double sd_starts[TWINMAP_PARAMETERS] = {@SD_STARTS@};

#if FMU_TRACKS
static void begin_track(fmu_block *block)
{
  int i;
  twinmap_track_begin(&block->track);
  for (i = 0; i < TWINMAP_PARAMETERS; ++i) {
    block->answer.mean[i] = block->result.mean[i];
    block->answer.sd[i] = block->result.sd[i];
    block->answer.lower[i] = block->result.lower[i];
    block->answer.upper[i] = block->result.upper[i];
  }
}

static double get_track(const fmu_block *block, int r)
{
  switch (r) {
    case ALARM_STATISTIC:
      return block->answer.alarm_statistic;
    case ALARM_TIME:
      return block->alarm.change_time;
    case ALARM_SIZE:
      return block->alarm.change_size;
    case ALARM_SD:
      return block->alarm.change_sd;
    default:
      break;
  }
  return r < FIRST_TRACK_SD      ? block->answer.mean[r - FIRST_TRACK_MEAN]
         : r < FIRST_TRACK_LOWER ? block->answer.sd[r - FIRST_TRACK_SD]
         : r < FIRST_TRACK_UPPER ? block->answer.lower[r - FIRST_TRACK_LOWER]
                                 : block->answer.upper[r - FIRST_TRACK_UPPER];
}

/* By the inference of the window that ends at a time; one that goes back is left out. */
static void update_track(fmu_block *block, double end)
{
  twinmap_track_answer answer;
  if (twinmap_track_update(&block->track, &block->result, end, NULL, &answer) == TWINMAP_TRACK_OK) {
    block->answer = answer;
    if (answer.alarm != TWINMAP_TRACK_QUIET) {
      block->alarm = answer;
      ++block->alarms;
    }
  }
}
#endif

/* Before the first inference nothing is known but the bounds. */
void fmu_reset(fmu_block *block)
{
  int i;
  memset(block, 0, sizeof *block);
  for (i = 0; i < TRIGGER; ++i) {
    block->inputs[i] = input_starts[i];
  }
  block->inputs[TRIGGER_TIME] = window_end;
  for (i = 0; i < TWINMAP_PARAMETERS; ++i) {
    block->result.mean[i] = mean_starts[i];
    block->result.sd[i] = sd_starts[i];
    block->result.lower[i] = mean_starts[i] - 1.959963984540054 * sd_starts[i];
    block->result.upper[i] = mean_starts[i] + 1.959963984540054 * sd_starts[i];
  }
  block->result.status = TWINMAP_STATUS_NOT_JUDGED;
#if FMU_TRACKS
  begin_track(block);
#endif
}

int fmu_get_real(const fmu_block *block, unsigned reference, double *value)
{
  const int r = (int)reference;
  if (r == TIME) {
    *value = block->count > 0 ? block->times[block->count - 1] : 0.0;
    return 1;
  }
#if FMU_TRACKS
  if (r >= FIRST_TRACK_MEAN && r <= ALARM_SD) {
    *value = get_track(block, r);
    return 1;
  }
#endif
  if (r < 0 || r > P_VALUE || r == TRIGGER) {
    return 0;
  }
  if (r < FIRST_MEAN) {
    *value = block->inputs[r];
  } else if (r < FIRST_SD) {
    *value = block->result.mean[r - FIRST_MEAN];
  } else if (r < FIRST_LOWER) {
    *value = block->result.sd[r - FIRST_SD];
  } else if (r < FIRST_UPPER) {
    *value = block->result.lower[r - FIRST_LOWER];
  } else if (r < P_VALUE) {
    *value = block->result.upper[r - FIRST_UPPER];
  } else {
    *value = block->result.p_value;
  }
  return 1;
}

int fmu_set_real(fmu_block *block, unsigned reference, double value)
{
  if (reference > TRIGGER_TIME || reference == TRIGGER) {
    return 0;
  }
  block->inputs[reference] = value;
  return 1;
}

int fmu_get_integer(const fmu_block *block, unsigned reference, int *value)
{
  switch (reference) {
    case STATUS:
      *value = (int)block->result.status;
      return 1;
    case STATUSES:
      *value = (int)block->result.statuses;
      return 1;
    case INFERENCES:
      *value = block->inferences;
      return 1;
    case MEASUREMENT_ERROR:
      *value = block->error;
      return 1;
#if FMU_TRACKS
    case ALARMS:
      *value = block->alarms;
      return 1;
    case ALARM_PARAMETER: /* from 1; 0: none, or several at once */
      *value = block->alarm.alarm == TWINMAP_TRACK_CHANGE ? block->alarm.parameter + 1 : 0;
      return 1;
#endif
    default:
      return 0;
  }
}

int fmu_get_boolean(const fmu_block *block, unsigned reference, int *value)
{
  *value = block->trigger;
  return reference == TRIGGER;
}

int fmu_set_boolean(fmu_block *block, unsigned reference, int value)
{
  if (reference == TRIGGER) {
    block->trigger = value != 0;
  }
  return reference == TRIGGER;
}

/* From the window that ends at a time. */
static void infer(fmu_block *block, double end)
{
  const twinmap_real *signals[TWINMAP_SIGNALS];
  twinmap_result result;
  int s;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    signals[s] = block->samples[s];
  }
  block->error = (int)twinmap_infer(&block->state, block->count, block->times, signals, end - window_end,
                                    block->inputs + FIRST_KNOWN, &result);
  if (block->error == (int)TWINMAP_OK) {
    block->result = result;
    ++block->inferences;
#if FMU_TRACKS
    update_track(block, end);
#endif
  }
}

/* The older half goes where there is no room. */
static void append(fmu_block *block, double time)
{
  int s;
  while (block->count > 0 && block->times[block->count - 1] >= time) {
    --block->count; /* the time was set back */
  }
  if (block->count == MOST_SAMPLES) {
    const int kept = MOST_SAMPLES / 2;
    memmove(block->times, block->times + kept, sizeof(double) * (size_t)kept);
    for (s = 0; s < TWINMAP_SIGNALS; ++s) {
      memmove(block->samples[s], block->samples[s] + kept, sizeof(twinmap_real) * (size_t)kept);
    }
    block->count = kept;
  }
  block->times[block->count] = time;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    block->samples[s][block->count] = (twinmap_real)block->inputs[s];
  }
  ++block->count;
}

void fmu_sample(fmu_block *block, double time)
{
  const double due = block->inputs[TRIGGER_TIME];
  append(block, time);
  if (!block->timed && due > 0.0 && time >= due - 1e-9 * due) {
    block->timed = 1;
    infer(block, due);
  }
  if (block->trigger && !block->trigger_before) {
    infer(block, time);
  }
  block->trigger_before = block->trigger;
}
