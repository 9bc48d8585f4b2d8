// Tests how declared parameters and registered policies are read, described and refused.
// SPDX-License-Identifier: Apache-2.0
#include "base/params.h"

#include <algorithm>

#include "base/registry.h"
#include "tests/support/catch.h"

namespace glint {
namespace {

struct Animal {
  static constexpr PolicyKind kKind{"zoo.animal", "zoo/animals"};
  struct Context {
    int legs;
  };
  virtual ~Animal() = default;
  virtual int speed() const = 0;
};

class Dog final : public Animal {
 public:
  static constexpr const char* kName = "dog";
  static constexpr const char* kDoc = "Barks.";
  struct Params {
    uint32_t factor = 3;
    static ParamList params() { return {param(&Params::factor, "factor", "", "Speed a leg.", 1, 9)}; }
  };
  Dog(const Params& params, Context context) : speed_(int(params.factor) * context.legs) {}
  int speed() const override { return speed_; }

 private:
  int speed_;
};
class Snail final : public Animal {
 public:
  static constexpr const char* kName = "snail";
  static constexpr const char* kDoc = "Does not.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Snail(Params, Context) {}
  int speed() const override { return 1; }
};
// The snail is registered before the dog, so that the test of the sorted listing can fail.
const Register<Animal, Snail> snail;
const Register<Animal, Dog> dog;

struct Inner {
  double ratio = 0.5;
  static ParamList params() { return {param(&Inner::ratio, "ratio", "fraction", "A share.", 0.0, 1.0)}; }
};
struct Outer {
  uint32_t warps = 32;
  bool fast = false;
  Inner inner;
  PolicyChoice<Animal> animal{"snail"};
  static ParamList params() {
    return {param(&Outer::warps, "warps", "warp", "Warps.", 1, 64), flag(&Outer::fast, "fast", "Go fast."),
            section(&Outer::inner, "inner", "Inside."), policy(&Outer::animal, "animal", "Which.")};
  }
};

Outer read(const std::string& toml, Diagnostics& diagnostics) {
  Config config;
  config.add_text("t.toml", toml);
  ConfigTable root = config.root(diagnostics);
  Outer outer;
  read_params(root, outer);
  return outer;
}

TEST_CASE("keys of nested sections and of the chosen policy are read") {
  Diagnostics diagnostics;
  const Outer outer = read(
      "warps = 4\nfast = true\nanimal = \"dog\"\n[inner]\nratio = 0.25\n[dog]\nfactor = 5\n", diagnostics);

  CHECK_FALSE(diagnostics.has_errors());
  CHECK(outer.warps == 4);
  CHECK(outer.fast);
  CHECK(outer.inner.ratio == 0.25);
  CHECK(outer.animal.make({4})->speed() == 20);
}

TEST_CASE("a policy without configuration has its default parameters") {
  CHECK(PolicyChoice<Animal>("dog").make({2})->speed() == 6);
  CHECK(Outer().animal.make({2})->speed() == 1);
}

TEST_CASE("every wrong key of every section is reported at once") {
  Diagnostics diagnostics;
  read("wraps = 4\n[inner]\nratio = 2.0\n[dog]\nfactr = 1\n", diagnostics);

  REQUIRE(diagnostics.messages().size() == 3);
  CHECK_THROWS_AS(diagnostics.throw_if_errors(), UserError);
}

TEST_CASE("parameters of a policy that is not chosen are still checked") {
  Diagnostics diagnostics;
  read("animal = \"snail\"\n[dog]\nfactor = 10\n", diagnostics);

  REQUIRE(diagnostics.messages().size() == 1);
  CHECK(diagnostics.messages()[0] == "t.toml:3:1: error: 'dog.factor' is 10, expected 1 to 9 ");
}

TEST_CASE("descriptions carry dotted keys, present values, units and ranges in declaration order") {
  Diagnostics diagnostics;
  const auto infos = describe_params(read("animal = \"dog\"\n", diagnostics), "x.");

  REQUIRE(infos.size() == 5);
  CHECK(infos[0].key == "x.warps");
  CHECK(infos[0].value == "32");
  CHECK(infos[0].unit == "warp");
  CHECK(infos[0].range == "1 to 64");
  CHECK(infos[1].range.empty());
  CHECK(infos[2].key == "x.inner.ratio");
  CHECK(infos[3].value == "\"dog\"");
  CHECK(infos[3].range == "dog, snail");
  CHECK(infos[4].key == "x.dog.factor");
}

TEST_CASE(
    "keys of a policy that is not chosen are described as they were read, with the choice that they need") {
  Diagnostics diagnostics;
  const auto infos = describe_params(read("animal = \"snail\"\n[dog]\nfactor = 4\n", diagnostics), "x.");

  const auto found = std::find_if(infos.begin(), infos.end(),
                                  [](const ParamInfo& info) { return info.key == "x.dog.factor"; });
  REQUIRE(found != infos.end());
  CHECK(found->value == "4");
  CHECK(found->needs == "x.animal = \"dog\"");
}

TEST_CASE("registered names are sorted whatever the order of registration") {
  CHECK(Registry<Animal>::names() == std::vector<std::string>{"dog", "snail"});
}

}  // namespace
}  // namespace glint
