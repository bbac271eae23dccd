#pragma once

#include <Eigen/Core>

/// Eigen's kernels of products and triangular solvers of doubles, compiled once by eigen_products.cpp:
/// without these declarations each translation unit with a product spends 2 s on them. Eigen keeps them out
/// of line, so the instructions are the same. Precompiled with the common headers; a build without these
/// compiles them as usual.
namespace Eigen::internal {

using TwinmapTile = gebp_traits<double, double>;
using TwinmapColumns = const_blas_data_mapper<double, Index, ColMajor>;
using TwinmapRows = const_blas_data_mapper<double, Index, RowMajor>;

extern template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>,
                                   TwinmapTile::mr, TwinmapTile::nr>;
extern template struct gemm_pack_lhs<double, Index, TwinmapColumns, TwinmapTile::mr, TwinmapTile::LhsProgress,
                                     TwinmapTile::LhsPacket4Packing, ColMajor>;
extern template struct gemm_pack_lhs<double, Index, TwinmapRows, TwinmapTile::mr, TwinmapTile::LhsProgress,
                                     TwinmapTile::LhsPacket4Packing, RowMajor>;
extern template struct gemm_pack_rhs<double, Index, TwinmapColumns, TwinmapTile::nr, ColMajor>;
extern template struct gemm_pack_rhs<double, Index, TwinmapRows, TwinmapTile::nr, RowMajor>;
extern template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor, false,
                                                     ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor, false,
                                                     ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor, false,
                                                     ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, RowMajor, false, double, RowMajor, false,
                                                     ColMajor, 1>;
extern template struct general_matrix_vector_product<Index, double, TwinmapColumns, ColMajor, false, double,
                                                     TwinmapRows, false>;
extern template struct general_matrix_vector_product<Index, double, TwinmapRows, RowMajor, false, double,
                                                     TwinmapColumns, false>;
extern template struct general_matrix_vector_product<Index, double, TwinmapRows, RowMajor, false, double,
                                                     TwinmapRows, false, Specialized>;
extern template void evaluateProductBlockingSizesHeuristic<double, double, 1, Index>(Index&, Index&, Index&,
                                                                                     Index);
extern template void evaluateProductBlockingSizesHeuristic<double, double, 4, Index>(Index&, Index&, Index&,
                                                                                     Index);

}  // namespace Eigen::internal
