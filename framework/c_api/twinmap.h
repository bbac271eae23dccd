/* twinmap.h: parameters from measurements by a trained map or an experiment alone, in C
 * (docs/how-to/use-from-c.md).
 *
 * A map is opened once and shared by all threads; each thread has an inferrer of its own, which takes one
 * measurement after another and keeps the estimate of the last. Nothing else is shared: functions with
 * different inferrers may run at the same time. No exception leaves a function; what went wrong is told by
 * its result, and in words by twinmap_get_error(). Texts that functions return belong to the map or the
 * inferrer, or are constant.
 */
#ifndef TWINMAP_H
#define TWINMAP_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define TWINMAP_API __attribute__((visibility("default")))
#else
#define TWINMAP_API
#endif

/** A trained map, or an experiment alone; immutable. */
typedef struct twinmap_map twinmap_map;

/** What infers by a map; for one thread at a time. */
typedef struct twinmap_inferrer twinmap_inferrer;

/** How a function ended. */
typedef enum twinmap_result {
  TWINMAP_OK = 0,
  TWINMAP_FAILED = 1, /**< a file that is missing or was made by another version, memory that is full ... */
  TWINMAP_WRONG_INPUT =
      2 /**< an argument or a measurement that cannot be used; the text says where and why */
} twinmap_result;

/** Whether estimates are refined by least squares on the simulator. */
typedef enum twinmap_refine {
  TWINMAP_REFINE_NEVER = 0,         /**< the map's estimate, in microseconds to a millisecond */
  TWINMAP_REFINE_AS_EXPERIMENT = 1, /**< as the command does: as the experiment's `refine` says */
  TWINMAP_REFINE_ALWAYS = 2
} twinmap_refine;

/** Whose posterior a measurement is given (docs/how-to/sample-the-posterior.md). */
typedef enum twinmap_posterior {
  TWINMAP_POSTERIOR_AS_NEEDED =
      0, /**< the simulator's, where estimates are refined and least squares may mislead */
  TWINMAP_POSTERIOR_AUTOMATIC =
      1, /**< always: the simulator's where that takes tenths of a second, else the map's */
  TWINMAP_POSTERIOR_SIMULATOR = 2,
  TWINMAP_POSTERIOR_SURROGATE = 3
} twinmap_posterior;

/** "0.2.0". */
TWINMAP_API const char* twinmap_get_version(void);

/** What went wrong in this thread's last function that did not return TWINMAP_OK; "" before. Valid until this
 * thread's next such function. */
TWINMAP_API const char* twinmap_get_error(void);

/* ---- The map ----------------------------------------------------------------------------------------------
 */

/** Opens the folder of a finished run, or its maps.h5, which holds all that is needed; or an experiment file
 * (.yaml): then nothing is trained, and each measurement's posterior is sampled on the simulator. *map is to
 * be closed; it is NULL unless the result is TWINMAP_OK. */
TWINMAP_API twinmap_result twinmap_open(const char* run_or_maps, twinmap_map** map);

/** Frees the map, once all its inferrers are closed. NULL is allowed. */
TWINMAP_API void twinmap_close(twinmap_map* map);

/** A parameter, feature, known input or output of the model. */
typedef struct twinmap_quantity {
  const char* name; /**< "k_y"; of a feature "y(0.05 s)" */
  const char* unit; /**< coherent SI; "" where none is stated */
  double lower;     /**< bounds of a parameter or input in training; NaN of others */
  double upper;
} twinmap_quantity;

/** How many parameters are inferred: p. */
TWINMAP_API size_t twinmap_count_parameters(const twinmap_map* map);
/** How many features a measurement has: d. */
TWINMAP_API size_t twinmap_count_features(const twinmap_map* map);
/** How many settings of the set-up must be known with a measurement: q. */
TWINMAP_API size_t twinmap_count_inputs(const twinmap_map* map);
/** How many signals of the machine a measurement holds. */
TWINMAP_API size_t twinmap_count_outputs(const twinmap_map* map);

/** Quantity `index` (from 0) of its kind; TWINMAP_WRONG_INPUT where there is none. */
TWINMAP_API twinmap_result twinmap_get_parameter(const twinmap_map* map, size_t index,
                                                 twinmap_quantity* quantity);
TWINMAP_API twinmap_result twinmap_get_feature(const twinmap_map* map, size_t index,
                                               twinmap_quantity* quantity);
TWINMAP_API twinmap_result twinmap_get_input(const twinmap_map* map, size_t index,
                                             twinmap_quantity* quantity);
TWINMAP_API twinmap_result twinmap_get_output(const twinmap_map* map, size_t index,
                                              twinmap_quantity* quantity);

/** Mean and standard deviation (rows x p each, row by row) for many measurements, given by their features
 * (rows x d) and known inputs (rows x q; NULL where q is 0): the map's alone, without status. The result does
 * not depend on the number of threads. TWINMAP_WRONG_INPUT for an experiment, which has no map. */
TWINMAP_API twinmap_result twinmap_predict(const twinmap_map* map, const double* features,
                                           const double* inputs, size_t rows, int threads, double* mean,
                                           double* stddev);

/* ---- Inference
 * ---------------------------------------------------------------------------------------------- */

/** *inferrer is to be closed; it is NULL unless the result is TWINMAP_OK. The map must stay open. */
TWINMAP_API twinmap_result twinmap_new_inferrer(const twinmap_map* map, twinmap_refine refine,
                                                twinmap_inferrer** inferrer);

/** The same with posteriors of so many draws a round; 0: 512. An experiment alone takes
 * TWINMAP_REFINE_AS_EXPERIMENT and any posterior but the surrogate's: it has no other estimate. */
TWINMAP_API twinmap_result twinmap_new_posterior_inferrer(const twinmap_map* map, twinmap_refine refine,
                                                          twinmap_posterior posterior, int draws,
                                                          twinmap_inferrer** inferrer);

/** Frees the inferrer. NULL is allowed. */
TWINMAP_API void twinmap_close_inferrer(twinmap_inferrer* inferrer);

/** The known inputs of the measurements to come: q values in the order of twinmap_get_input(), within their
 * bounds. Needed before the first inference where q is above 0. */
TWINMAP_API twinmap_result twinmap_set_inputs(twinmap_inferrer* inferrer, const double* values, size_t count);

/** Time in the measurements to come (s) at which the model's time is 0, instead of the experiment's. */
TWINMAP_API twinmap_result twinmap_set_start(twinmap_inferrer* inferrer, double start);

/** From d features. */
TWINMAP_API twinmap_result twinmap_infer_features(twinmap_inferrer* inferrer, const double* features,
                                                  size_t count);

/** A column of raw samples. */
typedef struct twinmap_column {
  const char* name;     /**< as in the header of a file: "t", "enc1 [mm]" (docs/how-to/read-recordings.md) */
  const double* values; /**< count */
  size_t count;
} twinmap_column;

/** From raw samples: a column of times and one for each output, at any rate; they are brought to the times of
 * the features. Columns that are not needed are ignored. */
TWINMAP_API twinmap_result twinmap_infer_columns(twinmap_inferrer* inferrer, const twinmap_column* columns,
                                                 size_t count);

/** From a file: CSV, MATLAB or HDF5. */
TWINMAP_API twinmap_result twinmap_infer_file(twinmap_inferrer* inferrer, const char* path);

/** From samples that come one by one: begins a measurement with columns of these names; what was pushed
 * before is forgotten, its memory kept. */
TWINMAP_API twinmap_result twinmap_begin(twinmap_inferrer* inferrer, const char* const* names, size_t count);
/** A value for each column. */
TWINMAP_API twinmap_result twinmap_push(twinmap_inferrer* inferrer, const double* values, size_t count);
/** From all that was pushed, which stays. */
TWINMAP_API twinmap_result twinmap_infer_pushed(twinmap_inferrer* inferrer);

/* ---- The estimate of the last measurement; TWINMAP_WRONG_INPUT unless its inference ended with TWINMAP_OK,
 * or where nothing is believed: an experiment alone whose status is "unreliable" or "not_simulated" ---- */

/** Mean, standard deviation: p values in the parameters' units. */
TWINMAP_API twinmap_result twinmap_get_mean(const twinmap_inferrer* inferrer, double* values, size_t count);
TWINMAP_API twinmap_result twinmap_get_stddev(const twinmap_inferrer* inferrer, double* values, size_t count);
/** The outermost bounds of the 95 % intervals: p values each. */
TWINMAP_API twinmap_result twinmap_get_interval(const twinmap_inferrer* inferrer, double* lower,
                                                double* upper, size_t count);
/** Joint covariance: p x p values, symmetric. */
TWINMAP_API twinmap_result twinmap_get_covariance(const twinmap_inferrer* inferrer, double* values,
                                                  size_t count);

/** How many values that lie apart may fit: the components of a mixture or the modes of a posterior; 1 where
 * the estimate is one, 0 without an estimate. */
TWINMAP_API size_t twinmap_count_components(const twinmap_inferrer* inferrer);
/** Weight, mean and standard deviation (p values each) of one of several components, from 0. */
TWINMAP_API twinmap_result twinmap_get_component(const twinmap_inferrer* inferrer, size_t index,
                                                 double* weight, double* mean, double* stddev, size_t count);

/** How many draws the estimate has: those of a posterior, else 0. */
TWINMAP_API size_t twinmap_count_draws(const twinmap_inferrer* inferrer);
/** All of them (draws x p, draw by draw) and their weights (draws), whose sum is 1. */
TWINMAP_API twinmap_result twinmap_get_draws(const twinmap_inferrer* inferrer, double* values,
                                             double* weights, size_t draws);

/** Whether the estimate is that of a refinement on the simulator that was accepted: 1 or 0. */
TWINMAP_API int twinmap_is_refined(const twinmap_inferrer* inferrer);

/** What made the estimate: "gp", "surrogate" or "network", the kind of the map, "refined", or "posterior";
 * NULL without an estimate. */
TWINMAP_API const char* twinmap_get_method(const twinmap_inferrer* inferrer);

/** How many statuses the estimate has; 0 without an estimate, or where the run has no trust model. */
TWINMAP_API size_t twinmap_count_statuses(const twinmap_inferrer* inferrer);
/** "ok", or what is to be said against the estimate, the most severe first: "model_mismatch",
 * "outside_training", "at_bounds", "uninformative", "multimodal", "nonlinear", "not_refined", "unreliable",
 * "uncalibrated", "estimator_limited", "posterior_uncalibrated", "not_simulated" (docs/explanation/trust.md). NULL beyond the last. */
TWINMAP_API const char* twinmap_get_status(const twinmap_inferrer* inferrer, size_t index);

/** Numbers behind the statuses. */
typedef enum twinmap_number {
  TWINMAP_P_VALUE = 0,            /**< of the residual, as if the model were right */
  TWINMAP_CHI_SQUARE = 1,         /**< sum of the squared residuals, in variances */
  TWINMAP_RESIDUALS = 2,          /**< how many */
  TWINMAP_CHI_SQUARE_P_VALUE = 3, /**< of that test alone */
  TWINMAP_ANOMALY_P_VALUE = 4,    /**< of the test for a disturbance that lasts a while */
  TWINMAP_DISTANCE = 5 /**< to the nearest training sample; 1: the farthest of simulated measurements */
} twinmap_number;

/** NaN without an estimate, or where nobody has judged; of an experiment alone, TWINMAP_ANOMALY_P_VALUE and
 * TWINMAP_DISTANCE are. */
TWINMAP_API double twinmap_get_number(const twinmap_inferrer* inferrer, twinmap_number number);

/** All of the estimate as a line of JSON, as `twinmap infer --json` prints it; NULL without an estimate.
 * Valid until the inferrer's next function. */
TWINMAP_API const char* twinmap_get_json(twinmap_inferrer* inferrer);

#ifdef __cplusplus
}
#endif

#endif
