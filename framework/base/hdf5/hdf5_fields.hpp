#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "framework/base/hdf5/hdf5_file.hpp"

namespace twinmap {

// One list of fields writes a value and reads it back: a template
//   template <class Fields, class T> void listFields(const Fields& fields, T& value)
// calls fields("name", value.member) for each member, with WrittenFields and a const value, or with
// ReadFields.

/// Writes each field below a group.
class WrittenFields {
 public:
  WrittenFields(Hdf5Writer& file, std::string group) : file_(file), group_(std::move(group)) {}
  WrittenFields in(const std::string& name) const { return {file_, group_ + "/" + name}; }

  template <class T>
  void operator()(const std::string& name, const T& value) const {
    if constexpr (std::is_same_v<T, Eigen::MatrixXd>) {
      file_.writeSamples(group_ + "/" + name, value);
    } else if constexpr (std::is_arithmetic_v<T>) {
      file_.write(group_ + "/" + name, static_cast<double>(value));
    } else {
      file_.write(group_ + "/" + name, value);
    }
  }
  void transposed(const std::string& name, const Eigen::MatrixXd& value) const {
    file_.writeSamples(group_ + "/" + name, value.transpose());
  }
  /// As to(value), which from() makes a value again.
  template <class T, class To, class From>
  void converted(const std::string& name, const T& value, const To& to, const From&) const {
    (*this)(name, to(value));
  }
  /// An attribute of the group: the names of the enumeration's values in their order.
  template <class Enum>
  void choice(const char* name, Enum value, std::initializer_list<const char*> names) const {
    file_.writeAttribute(group_, name, names.begin()[static_cast<std::size_t>(value)]);
  }
  /// How many items there are, as "count", and each in a group of its number.
  template <class Items, class Visit>
  void each(const std::string& count, const std::string& name, const Items& items, const Visit& visit) const {
    (*this)(count, items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      visit(in(name + "/" + std::to_string(i)), items[i]);
    }
  }
  /// Whether a field is there that some values lack.
  bool has(const std::string&, bool written) const { return written; }
  void require(bool) const {}

 private:
  Hdf5Writer& file_;
  std::string group_;
};

/// Reads them back. Throws std::runtime_error for what is missing or unknown.
class ReadFields {
 public:
  ReadFields(const Hdf5Reader& file, std::string group) : file_(file), group_(std::move(group)) {}
  ReadFields in(const std::string& name) const { return {file_, group_ + "/" + name}; }

  template <class T>
  void operator()(const std::string& name, T& value) const {
    const std::string path = group_ + "/" + name;
    if constexpr (std::is_same_v<T, Eigen::MatrixXd>) {
      value = file_.readSamples(path);
    } else if constexpr (std::is_same_v<T, Eigen::VectorXd>) {
      value = file_.readVector(path);
    } else if constexpr (std::is_floating_point_v<T>) {
      value = file_.readNumber(path);
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(file_.readCount(path));
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      value = file_.readTexts(path);
    } else {
      value = file_.readIntegers(path);
    }
  }
  void transposed(const std::string& name, Eigen::MatrixXd& value) const {
    value = file_.readSamples(group_ + "/" + name).transpose();
  }
  template <class T, class To, class From>
  void converted(const std::string& name, T& value, const To& to, const From& from) const {
    std::decay_t<decltype(to(value))> stored{};
    (*this)(name, stored);
    value = from(stored);
  }
  template <class Enum>
  void choice(const char* name, Enum& value, std::initializer_list<const char*> names) const {
    const std::string text = file_.readAttribute(group_, name);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (text == names.begin()[i]) {
        value = static_cast<Enum>(i);
        return;
      }
    }
    throw std::runtime_error(file_.getPath() + ": " + group_ + " has an unknown '" + text + "'");
  }
  template <class Items, class Visit>
  void each(const std::string& count, const std::string& name, Items& items, const Visit& visit) const {
    std::size_t size = 0;
    (*this)(count, size);
    items.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      visit(in(name + "/" + std::to_string(i)), items[i]);
    }
  }
  bool has(const std::string& name, bool) const { return file_.contains(group_ + "/" + name); }
  /// Throws std::runtime_error where the parts of what was read do not fit each other.
  void require(bool fits) const {
    if (!fits) {
      throw std::runtime_error(file_.getPath() + ": " + group_ + " has parts that do not fit each other");
    }
  }

 private:
  const Hdf5Reader& file_;
  std::string group_;
};

}  // namespace twinmap
