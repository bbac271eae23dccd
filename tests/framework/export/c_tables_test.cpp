#include "framework/export/c_code/c_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/export/c_code/c_source.hpp"
#include "framework/export/c_code/runtime_sources.hpp"

namespace twinmap {
namespace {

TEST(CTables, LiteralsReadBackAsTheSameBits) {
  for (const double value : {0.1, 1.0 / 3.0, -1e-300, 6.02e23, 0.0, 12345.0}) {
    EXPECT_EQ(std::stod(toC(value)), value);
    const auto single = static_cast<float>(value);
    if (std::isfinite(single) && single != 0.0F) {
      EXPECT_EQ(std::stof(toC(value, CNumber::kSingle)), single);
    }
  }
}

TEST(CTables, WholeNumbersAreNoIntegersInC) {
  EXPECT_EQ(toC(3.0), "3.0");
  EXPECT_EQ(toC(3.0, CNumber::kSingle), "3.0f");
}

TEST(CTables, WhatIsNotFiniteIsRefused) {
  EXPECT_THROW(toC(std::numeric_limits<double>::quiet_NaN()), std::runtime_error);
  EXPECT_THROW(toC(std::numeric_limits<double>::infinity()), std::runtime_error);
}

TEST(CTables, StringsAreEscaped) {
  EXPECT_EQ(quoteC("a\"b\\"), "\"a\\\"b\\\\\"");
  EXPECT_EQ(quoteC("\xc2\xb5m"), "\"\\302\\265m\"");
}

TEST(CTables, BytesAreThoseOfTheStorage) {
  CTables tables(CNumber::kSingle);
  tables.addWide("wide", Eigen::VectorXd::Ones(3), "three");
  tables.addReal("real", Eigen::VectorXd::Ones(3), "three");
  EXPECT_EQ(tables.getBytes(), 3 * sizeof(double) + 3 * sizeof(float));
  EXPECT_NE(tables.getText().find("/* three */\nstatic const real_t real[3] = {\n  1.0f, 1.0f, 1.0f};"),
            std::string::npos);
}

TEST(RuntimeSources, NamesTakeThePrefixAndUnknownFilesAreRefused) {
  EXPECT_EQ(renameC("twinmap_infer(TWINMAP_OK)", "pump"), "pump_infer(PUMP_OK)");
  EXPECT_NE(getRuntimeSource("arithmetic.c").find("static inline double exponential"),
            std::string_view::npos);
  EXPECT_EQ(getRuntimeSource("arithmetic.c").find("@@FILE"), std::string_view::npos);
  EXPECT_THROW(getRuntimeSource("none.c"), std::logic_error);
  EXPECT_EQ(fillSlot("a @X@ b @X@", "@X@", "@X@@"), "a @X@@ b @X@@");
}

}  // namespace
}  // namespace twinmap
