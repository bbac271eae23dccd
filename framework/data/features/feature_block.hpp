#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

namespace twinmap {

/// What one feature is.
struct FeatureInfo {
  std::string name;          ///< "y(0.05 s)"
  std::string unit;          ///< of the feature; "" for a number without
  int output = -1;           ///< index of the output it is made of, or -1
  double time = 0.0;         ///< s; of a feature that has no time of its own 0
  std::string excitation{};  ///< the signal, of a part of a frequency response; else empty
  double frequency = 0.0;    ///< Hz, of its line
  bool is_at_start = false;  ///< whether its time is 0, and not that of a feature without one

  /// Whether it is one output at one time.
  bool isSample() const { return output >= 0 && (time > 0.0 || is_at_start); }
};

/// features = matrix * response; one row a feature.
using FeatureMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The features of one entry of the experiment's list, compiled for a layout. Immutable.
class FeatureBlock {
 public:
  virtual ~FeatureBlock() = default;

  const std::vector<FeatureInfo>& getInfos() const { return infos_; }

  /// Responses (rows of the layout x n) -> features (infos x n). A feature that a response does not have,
  /// such as a third peak, is NaN, and so are the features of a failed sample.
  virtual void extract(const Eigen::Ref<const Eigen::MatrixXd>& responses,
                       Eigen::Ref<Eigen::MatrixXd> features) const = 0;

  /// The matrix of features that are linear in the response, null of others.
  virtual const FeatureMatrix* findMatrix() const { return nullptr; }

  /// Features linear in the response that stand for these one to one, as real and imaginary parts do for
  /// magnitude and phase: their noise is normal and the same for every response. Null where there are none.
  virtual std::shared_ptr<const FeatureBlock> findLinearForm() const { return nullptr; }
  /// Puts a vector of the linear form in the places of the features that it stands for, 0 in those left over.
  virtual void placeLinearForm(const Eigen::Ref<const Eigen::VectorXd>& linear,
                               Eigen::Ref<Eigen::VectorXd> placed) const {
    placed = linear;
  }
  /// From features (infos x n) to those of the linear form (its infos x n); as they are where there is none.
  virtual void convertToLinearForm(const Eigen::Ref<const Eigen::MatrixXd>& features,
                                   Eigen::Ref<Eigen::MatrixXd> linear) const {
    linear = features;
  }
  /// And back.
  virtual void convertFromLinearForm(const Eigen::Ref<const Eigen::MatrixXd>& linear,
                                     Eigen::Ref<Eigen::MatrixXd> features) const {
    features = linear;
  }

 protected:
  explicit FeatureBlock(std::vector<FeatureInfo> infos) : infos_(std::move(infos)) {}

 private:
  std::vector<FeatureInfo> infos_;
};

/// Features that are linear in the response.
class LinearBlock final : public FeatureBlock {
 public:
  LinearBlock(std::vector<FeatureInfo> infos, const FeatureMatrix& matrix)
      : FeatureBlock(std::move(infos)), matrix_(matrix) {}

  void extract(const Eigen::Ref<const Eigen::MatrixXd>& responses,
               Eigen::Ref<Eigen::MatrixXd> features) const override {
    features = matrix_ * responses;
  }
  const FeatureMatrix* findMatrix() const override { return &matrix_; }

 private:
  FeatureMatrix matrix_;
};

}  // namespace twinmap
