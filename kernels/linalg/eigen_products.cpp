#include "kernels/linalg/eigen_products.hpp"

namespace Eigen::internal {

template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>, TwinmapTile::mr,
                            TwinmapTile::nr>;
template struct gemm_pack_lhs<double, Index, TwinmapColumns, TwinmapTile::mr, TwinmapTile::LhsProgress,
                              TwinmapTile::LhsPacket4Packing, ColMajor>;
template struct gemm_pack_lhs<double, Index, TwinmapRows, TwinmapTile::mr, TwinmapTile::LhsProgress,
                              TwinmapTile::LhsPacket4Packing, RowMajor>;
template struct gemm_pack_rhs<double, Index, TwinmapColumns, TwinmapTile::nr, ColMajor>;
template struct gemm_pack_rhs<double, Index, TwinmapRows, TwinmapTile::nr, RowMajor>;
template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor, false,
                                              ColMajor, 1>;
template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor, false,
                                              ColMajor, 1>;
template struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor, false,
                                              ColMajor, 1>;
template struct general_matrix_matrix_product<Index, double, RowMajor, false, double, RowMajor, false,
                                              ColMajor, 1>;
template struct general_matrix_vector_product<Index, double, TwinmapColumns, ColMajor, false, double,
                                              TwinmapRows, false>;
template struct general_matrix_vector_product<Index, double, TwinmapRows, RowMajor, false, double,
                                              TwinmapColumns, false>;
template struct general_matrix_vector_product<Index, double, TwinmapRows, RowMajor, false, double,
                                              TwinmapRows, false, Specialized>;
template void evaluateProductBlockingSizesHeuristic<double, double, 1, Index>(Index&, Index&, Index&, Index);
template void evaluateProductBlockingSizesHeuristic<double, double, 4, Index>(Index&, Index&, Index&, Index);

}  // namespace Eigen::internal
