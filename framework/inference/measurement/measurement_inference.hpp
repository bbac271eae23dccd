#pragma once

#include <optional>
#include <string>

#include "framework/inference/inferrer.hpp"
#include "framework/inference/measurement_reader.hpp"

namespace twinmap {

/// Infers one measurement after another, by a trained run or by simulation alone; for one thread.
class MeasurementInference {
 public:
  virtual ~MeasurementInference() = default;

  virtual const MeasurementReader& getReader() const = 0;

  /// Whether estimates are refined, and whether each is given a posterior because that was asked for.
  virtual bool refines() const = 0;
  virtual bool samplesPosteriors() const = 0;

  /// What empty cells of a table are to it: missing samples, or an error where every feature is needed.
  virtual MissingCells getMissingCells() const = 0;

  /// From features (d, finite) that were extracted elsewhere. known: the inputs of the set-up (q).
  virtual InferredMeasurement infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) = 0;

  /// From a table: throws MeasurementError where it cannot be used (MeasurementReader::readFeatures).
  virtual InferredMeasurement infer(const Table& table, std::optional<double> start,
                                    const Eigen::VectorXd& known);

 protected:
  /// What the features (d) of a response that was read from a table say.
  InferredMeasurement inferResponse(const Table& table, std::optional<double> start,
                                    const Eigen::VectorXd& response, const Eigen::VectorXd& features,
                                    const Eigen::VectorXd& known);

 private:
  /// Which simple fault explains what was inferred of a measured response; "" where none does, or where
  /// nothing trained can ask that fast.
  virtual std::string findFault(const Eigen::VectorXd& response, const Eigen::VectorXd& known,
                                const InferredMeasurement& inferred);
};

}  // namespace twinmap
