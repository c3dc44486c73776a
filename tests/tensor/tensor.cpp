#include "tensor/tensor.h"

#include <gtest/gtest.h>

namespace wisp {
namespace {

TEST(Tensor, VoigtOrderIsTheDocumentedOne) {
  Mat<3> a;
  a << 1, 4, 6, 4, 2, 5, 6, 5, 3;
  Sym<3> s;
  s << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(symmetric<3>(a), s);
  EXPECT_EQ(matrix<3>(s), a);
  for (int c = 0; c < 6; ++c) EXPECT_EQ(a(sym_i<3>[c], sym_j<3>[c]), s[c]);

  Mat<2> b;
  b << 1, 3, 5, 2;
  EXPECT_EQ(symmetric<2>(b), Sym<2>(1, 2, 0, 4));
  EXPECT_EQ(matrix<2>(Sym<2>(1, 2, 7, 4)), (Mat<2>() << 1, 4, 4, 2).finished());
}

TEST(Tensor, ContractionCountsShearTwice) {
  Sym<3> s;
  s << 1, 2, 3, 4, 5, 6;
  EXPECT_DOUBLE_EQ(contract<3>(s, s), matrix<3>(s).squaredNorm());
  EXPECT_DOUBLE_EQ(contract<3>(s, s), s.dot(engineering<3>(s)));
  EXPECT_DOUBLE_EQ(contract<2>(Sym<2>(1, 2, 3, 4), Sym<2>(5, 6, 7, 8)), 5 + 12 + 21 + 64);
}

TEST(Tensor, DeviatorHasNoTraceInPlaneStrainEither) {
  const Sym<2> d = deviator<2>(Sym<2>(3, 4, 5, 6));
  EXPECT_EQ(d, Sym<2>(-1, 0, 1, 6));
  EXPECT_EQ(deviator<3>(sym_identity<3>()), Sym<3>::Zero());
}

TEST(Tensor, CongruenceLeavesTheOutOfPlaneComponent) {
  Mat<2> a;
  a << 1, 2, 3, 5;
  const Sym<2> s(2, 1, 9, -1);
  const Mat<2> expected = a * matrix<2>(s) * a.transpose();
  const Sym<2> r = congruence<2>(a, s);
  EXPECT_EQ(matrix<2>(r), expected);
  EXPECT_EQ(r[2], 9);
}

}  // namespace
}  // namespace wisp
