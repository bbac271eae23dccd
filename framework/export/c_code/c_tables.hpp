#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace twinmap {

/// How the constants of exported C are stored.
enum class CNumber { kDouble, kSingle };

/// C source of constants: each with what it means, its unit and its shape.
class CTables {
 public:
  /// `storage`: of tables that tolerate rounding to it; the others are doubles.
  explicit CTables(CNumber storage) : storage_(storage) {}

  /// static const double NAME[]. `meaning` becomes the comment above it.
  void addWide(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
               const std::string& meaning);
  /// The same in the storage's type (real_t).
  void addReal(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
               const std::string& meaning);
  void addInts(const std::string& name, const std::vector<int>& values, const std::string& meaning);
  void addNumber(const std::string& name, double value, const std::string& meaning);
  /// An array of structs, `entries` their initialisers.
  void addStructs(const std::string& type, const std::string& name, const std::vector<std::string>& entries,
                  const std::string& meaning);
  void addStrings(const std::string& name, const std::vector<std::string>& texts, const std::string& meaning);

  const std::string& getText() const { return text_; }
  std::size_t getBytes() const { return bytes_; }

 private:
  void addArray(const char* type, const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
                const std::string& meaning, CNumber number);

  CNumber storage_;
  std::string text_;
  std::size_t bytes_ = 0;
};

/// A literal that reads back as the same bits.
std::string toC(double value, CNumber number = CNumber::kDouble);
/// In capitals, as enumerators and macros are.
std::string toUpper(std::string text);
/// A string literal.
std::string quoteC(const std::string& text);
/// All numbers of a matrix, column by column, or row by row.
Eigen::VectorXd flattenColumns(const Eigen::MatrixXd& matrix);
Eigen::VectorXd flattenRows(const Eigen::MatrixXd& matrix);

}  // namespace twinmap
