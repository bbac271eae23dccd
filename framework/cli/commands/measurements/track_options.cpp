#include "framework/cli/commands/measurements/track_options.hpp"

namespace twinmap::cli {

TrackOptions makeTrackOptions(const TwinArguments& arguments) {
  TrackOptions options;
  options.tracking = findTracking(arguments.run, arguments.tracking);
  options.use = arguments.use;
  options.known = arguments.known;
  options.lag = arguments.lag;
  options.session.refine = arguments.refine;
  return options;
}

}  // namespace twinmap::cli
