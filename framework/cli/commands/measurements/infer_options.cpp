#include "framework/cli/commands/measurements/infer_options.hpp"

namespace twinmap::cli {

SessionOptions makeSessionOptions(const InferArguments& arguments) {
  SessionOptions options{arguments.refine, arguments.posterior_draws, {}};
  if (!arguments.posterior_from.empty()) {
    options.posterior_from = arguments.posterior_from == toString(PosteriorSource::kSurrogate)
                                 ? PosteriorSource::kSurrogate
                                 : PosteriorSource::kSimulator;
    options.posterior_draws = options.posterior_draws != 0 ? options.posterior_draws : kDefaultPosteriorDraws;
  }
  if (!arguments.profile.empty()) {
    options.profiles = true;
    options.posterior_draws =
        options.posterior_draws != 0 ? options.posterior_draws : SimulatorPosteriorOptions{}.draws;
    options.posterior_from = options.posterior_from.value_or(PosteriorSource::kSimulator);
    if (options.posterior_from == PosteriorSource::kSurrogate) {
      throw ExperimentError("--profile is of the simulator: leave --posterior-from out");
    }
  }
  return options;
}

}  // namespace twinmap::cli
