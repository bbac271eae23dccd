/* The map as a simulator's block: it keeps the samples of its inputs and infers when it is told to. */
#ifndef TWINMAP_FMU_H
#define TWINMAP_FMU_H

#include "twinmap_map.h"

#define FMU_TRACKS @TRACKS@ /* 1: each inference updates a belief over the parameters */
#if FMU_TRACKS
#include "twinmap_track.h"
#endif

enum {
  MOST_SAMPLES = 16384,
  FIRST_KNOWN = TWINMAP_SIGNALS,
  TRIGGER = TWINMAP_SIGNALS + TWINMAP_KNOWN,
  TRIGGER_TIME,
  FIRST_MEAN,
  FIRST_SD = FIRST_MEAN + TWINMAP_PARAMETERS,
  FIRST_LOWER = FIRST_SD + TWINMAP_PARAMETERS,
  FIRST_UPPER = FIRST_LOWER + TWINMAP_PARAMETERS,
  P_VALUE = FIRST_UPPER + TWINMAP_PARAMETERS,
  STATUS,
  STATUSES,
  INFERENCES,
  MEASUREMENT_ERROR,
#if FMU_TRACKS
  FIRST_TRACK_MEAN,
  FIRST_TRACK_SD = FIRST_TRACK_MEAN + TWINMAP_PARAMETERS,
  FIRST_TRACK_LOWER = FIRST_TRACK_SD + TWINMAP_PARAMETERS,
  FIRST_TRACK_UPPER = FIRST_TRACK_LOWER + TWINMAP_PARAMETERS,
  ALARM_STATISTIC = FIRST_TRACK_UPPER + TWINMAP_PARAMETERS,
  ALARM_TIME,
  ALARM_SIZE,
  ALARM_SD,
  ALARMS,
  ALARM_PARAMETER,
#endif
  TIME
};

/* Value references are the enumerators above. */
typedef struct {
  twinmap_state state;
  twinmap_result result;
  double times[MOST_SAMPLES];
  twinmap_real samples[TWINMAP_SIGNALS][MOST_SAMPLES];
  double inputs[TWINMAP_SIGNALS + TWINMAP_KNOWN + 2];
  int count, trigger, trigger_before, timed, inferences, error;
#if FMU_TRACKS
  twinmap_track track;
  twinmap_track_answer answer, alarm; /* the last, and the last that announced a change */
  int alarms;
#endif
} fmu_block;

void fmu_reset(fmu_block *block);

/* 1, or 0 for a reference that is none of that type. */
int fmu_get_real(const fmu_block *block, unsigned reference, double *value);
int fmu_set_real(fmu_block *block, unsigned reference, double value);
int fmu_get_integer(const fmu_block *block, unsigned reference, int *value);
int fmu_get_boolean(const fmu_block *block, unsigned reference, int *value);
int fmu_set_boolean(fmu_block *block, unsigned reference, int value);

/* The inputs are those at this time (s). */
void fmu_sample(fmu_block *block, double time);

#endif
