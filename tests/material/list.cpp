#include "material/list.h"

#include <set>
#include <string>

#include "material/samples.h"

namespace wisp::test {
namespace {

TEST(MaterialList, MakesTheGroupOfTheLawThatItIsGiven) {
  VonMises law = sample_law<VonMises>();
  law.density = 7.0;
  const AnyMaterial<3> group = make_material<3>(AnyLaw(law));
  ASSERT_TRUE((std::holds_alternative<MaterialStates<VonMises, 3>>(group)));
  const auto& states = std::get<MaterialStates<VonMises, 3>>(group);
  EXPECT_EQ(states.law.yield_stress, 20.0);
  EXPECT_TRUE(states.old.empty());
  EXPECT_TRUE(states.now.empty());
  EXPECT_EQ(density(AnyLaw(law)), 7.0);
  EXPECT_EQ(p_wave_modulus(AnyLaw(law)), law.p_wave_modulus());
}

template <class Law>
void described_well(std::set<std::string>& names) {
  EXPECT_TRUE(names.insert(std::string(Law::name)).second) << Law::name << " is listed twice";
  EXPECT_FALSE(Law::summary.empty());
  std::set<std::string> keys;
  const Law law;
  for_each_key<Law>([&](const auto& k) {
    EXPECT_TRUE(keys.insert(std::string(k.name)).second) << k.name;
    EXPECT_FALSE(k.meaning.empty()) << k.name;
    EXPECT_FALSE(k.unit.empty()) << k.name;
    const double value = law.*(k.member);
    EXPECT_TRUE(k.least_excluded ? value > k.least : value >= k.least) << k.name;
    EXPECT_TRUE(k.most_excluded ? value < k.most : value <= k.most) << k.name;
  });
  for (const char* name : {"density", "young_modulus", "poisson_ratio"})
    EXPECT_TRUE(keys.contains(name)) << name;
}

TEST(MaterialList, NamesAreUniqueAndDefaultsLieInTheirRanges) {
  std::set<std::string> names;
  [&]<class... Laws>(const std::variant<Laws...>*) {
    (described_well<Laws>(names), ...);
  }(static_cast<AnyLaw*>(nullptr));
  EXPECT_EQ(names.size(), std::variant_size_v<AnyLaw>);
}

}  // namespace
}  // namespace wisp::test
