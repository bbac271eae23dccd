#include "framework/data/features/complex_lines.hpp"

#include <cmath>
#include <cstdio>

namespace twinmap {
namespace {

using Eigen::Index;

constexpr double kTwoPi = 6.283185307179586;

double calcWindowFunction(WindowFunction function, int i, int count) {
  return function == WindowFunction::kHann ? 0.5 - 0.5 * std::cos(kTwoPi * i / count) : 1.0;
}

/// Rows 2 i and 2 i + 1: real and imaginary part of line i.
FeatureMatrix makeMatrix(const std::vector<ComplexLine>& lines, Index rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto row = static_cast<int>(2 * i);
    for (std::size_t k = 0; k < lines[i].rows.size(); ++k) {
      const auto column = static_cast<int>(lines[i].rows[k]);
      const std::complex<double> weight = lines[i].weights[static_cast<Index>(k)];
      entries.emplace_back(row, column, weight.real());
      entries.emplace_back(row + 1, column, weight.imag());
    }
  }
  FeatureMatrix matrix(static_cast<Index>(2 * lines.size()), rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

FeatureInfo makeLineInfo(const std::string& before, const ComplexLine& line, const std::string& after,
                         const std::string& unit) {
  char frequency[32];
  std::snprintf(frequency, sizeof frequency, " at %.6g Hz", line.frequency);
  return {before + line.name + after + frequency, unit, line.output, 0.0, line.excitation, line.frequency};
}

std::vector<FeatureInfo> makeInfos(const std::vector<ComplexLine>& lines, ComplexParts parts) {
  std::vector<FeatureInfo> infos;
  for (const ComplexLine& line : lines) {
    if (parts == ComplexParts::kRealImaginary) {
      infos.push_back(makeLineInfo("Re ", line, "", line.unit));
      infos.push_back(makeLineInfo("Im ", line, "", line.unit));
    } else {
      infos.push_back(makeLineInfo("|", line, "|", line.unit));
      infos.push_back(makeLineInfo("cos phase ", line, "", ""));
      infos.push_back(makeLineInfo("sin phase ", line, "", ""));
    }
  }
  return infos;
}

class MagnitudePhaseBlock final : public FeatureBlock {
 public:
  /// parts: the real and imaginary parts that it is made of.
  MagnitudePhaseBlock(std::vector<FeatureInfo> infos, std::shared_ptr<const LinearBlock> parts)
      : FeatureBlock(std::move(infos)), parts_(std::move(parts)) {}

  void extract(const Eigen::Ref<const Eigen::MatrixXd>& responses,
               Eigen::Ref<Eigen::MatrixXd> features) const override {
    convertFromLinearForm(*parts_->findMatrix() * responses, features);
  }

  std::shared_ptr<const FeatureBlock> findLinearForm() const override { return parts_; }

  void convertToLinearForm(const Eigen::Ref<const Eigen::MatrixXd>& features,
                           Eigen::Ref<Eigen::MatrixXd> linear) const override {
    for (Index line = 0; 3 * line < features.rows(); ++line) {
      linear.middleRows(2 * line, 2) =
          features.middleRows(3 * line + 1, 2).array().rowwise() * features.row(3 * line).array();
    }
  }

  void convertFromLinearForm(const Eigen::Ref<const Eigen::MatrixXd>& parts,
                             Eigen::Ref<Eigen::MatrixXd> features) const override {
    for (Index sample = 0; sample < parts.cols(); ++sample) {
      for (Index line = 0; 2 * line < parts.rows(); ++line) {
        const double real = parts(2 * line, sample), imaginary = parts(2 * line + 1, sample);
        const double magnitude = std::hypot(real, imaginary);
        features(3 * line, sample) = magnitude;
        features(3 * line + 1, sample) = real / magnitude;
        features(3 * line + 2, sample) = imaginary / magnitude;
      }
    }
  }

  void placeLinearForm(const Eigen::Ref<const Eigen::VectorXd>& linear,
                       Eigen::Ref<Eigen::VectorXd> placed) const override {
    for (Index line = 0; 3 * line < placed.size(); ++line) {
      placed.segment(3 * line, 2) = linear.segment(2 * line, 2);
      placed[3 * line + 2] = 0.0;
    }
  }

 private:
  std::shared_ptr<const LinearBlock> parts_;
};

}  // namespace

Eigen::VectorXcd calcLineWeights(const WindowSpec& window, const Frequency& frequency,
                                 WindowFunction window_function) {
  const int line = calcLine(window, frequency);
  const double start = std::fmod(line * (window.start / (window.interval * window.count)), 1.0);  // cycles
  Eigen::VectorXcd weights(window.count);
  double sum = 0.0;
  for (int i = 0; i < window.count; ++i) {
    const double factor = calcWindowFunction(window_function, i, window.count);
    const double cycles = start + std::fmod(static_cast<double>(line) * i / window.count, 1.0);
    weights[i] = std::polar(factor, -kTwoPi * cycles);
    sum += factor;
  }
  return weights * (2.0 / sum);
}

std::shared_ptr<const FeatureBlock> makeComplexBlock(const std::vector<ComplexLine>& lines,
                                                     ComplexParts parts, Index rows) {
  auto linear = std::make_shared<const LinearBlock>(makeInfos(lines, ComplexParts::kRealImaginary),
                                                    makeMatrix(lines, rows));
  if (parts == ComplexParts::kRealImaginary) {
    return linear;
  }
  return std::make_shared<MagnitudePhaseBlock>(makeInfos(lines, parts), std::move(linear));
}

}  // namespace twinmap
