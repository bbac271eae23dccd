#include "framework/tracking/track_session.hpp"

#include <sstream>

#include "framework/base/json/json.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

struct TrackSession::Parts {
  const InferenceSource& source;
  std::filesystem::path state;
  TrackOptions options;
  std::unique_ptr<MeasurementInference> inference;
  Eigen::VectorXd known;
  int count = 0;

  const std::vector<ParameterSpec>& getParameters() const { return source.getExperiment().model.parameters; }

  Json update(const Table& table, const MeasurementContext& context) {
    const InferredMeasurement inferred = inference->infer(table, context.start, known);
    Json json = makeAnswerJson(inferred, selectEstimate(inferred), getParameters(),
                               source.getReader().getExtractor().getInfos());
    json["track"] = {{"measurements", ++count}};
    return json;
  }
};

TrackSession::TrackSession(const InferenceSource& source, std::filesystem::path state, TrackOptions options)
    : parts_(new Parts{source, std::move(state), std::move(options), nullptr, {}}) {
  parts_->inference = source.makeSession(parts_->options.session);
  parts_->known = collectKnown(source.getExperiment().model.inputs, parseKnownValues(parts_->options.known));
}

TrackSession::~TrackSession() = default;

Json TrackSession::update(const std::string& text, const std::string& name,
                          const MeasurementContext& context) {
  std::istringstream stream(text);
  return parts_->update(
      readCsv(stream, name, parts_->source.getReader().listColumns(), parts_->inference->getMissingCells()),
      context);
}

Json TrackSession::updateFile(const std::filesystem::path& file, const MeasurementContext& context) {
  return parts_->update(
      readTable(file, parts_->source.getReader().listColumns(), parts_->inference->getMissingCells()),
      context);
}

Json TrackSession::getState() const {
  return {{"measurements", parts_->count}};
}

std::string TrackSession::makeHistory() const {
  return "";
}

std::filesystem::path TrackSession::getHistoryFile() const {
  return std::filesystem::path(parts_->state).replace_extension(".csv");
}

}  // namespace twinmap
