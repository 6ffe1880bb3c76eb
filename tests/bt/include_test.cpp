// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include "tests/bt/errors.hpp"
#include "tests/folders/folders.hpp"

namespace adit::bt::test {

namespace {

namespace fs = std::filesystem;

class Include : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "sub"); }

  std::string write(const std::string& name, const std::string& content) {
    const auto path = folder_ / name;
    std::ofstream(path) << "<root BTCPP_format=\"4\">" << content << "</root>";
    return path.string();
  }
  static std::string tree(const std::string& id, const std::string& body) {
    return "<BehaviorTree ID=\"" + id + "\">" + body + "</BehaviorTree>";
  }
  std::string load(const std::string& path, const std::string& main = "") {
    auto loaded = load_tree_file(tolerant(), path, main);
    return loaded.ok() ? "ok" : loaded.error().text;
  }
  fs::path folder_{scratch_folder()};
};

}  // namespace

TEST_F(Include, IsRelativeToTheFileThatIncludes) {
  write("sub/leaf.xml", tree("Leaf", "<X/>"));
  write("sub/mid.xml", "<include path=\"leaf.xml\"/>" + tree("Mid", "<SubTree ID=\"Leaf\"/>"));
  const auto top = write("top.xml", "<include path=\"sub/mid.xml\"/>" + tree("Top", "<SubTree ID=\"Mid\"/>"));
  EXPECT_EQ(load(top, "Top"), "ok");
  const auto ids = check_tree_file(tolerant(), top);
  ASSERT_TRUE(ids.ok());
  EXPECT_EQ(*ids, (std::vector<std::string>{"Leaf", "Mid", "Top"}));
}

TEST_F(Include, AFileReachedOnTwoWaysIsReadOnce) {
  write("leaf.xml", tree("Leaf", "<X/>"));
  write("a.xml", "<include path=\"leaf.xml\"/>");
  const auto top = write("top.xml", "<include path=\"a.xml\"/><include path=\"sub/../leaf.xml\"/>" +
                                        tree("Top", "<SubTree ID=\"Leaf\"/>"));
  EXPECT_EQ(load(top, "Top"), "ok");
}

TEST_F(Include, Errors) {
  const auto missing = write("top.xml", "\n<include path=\"gone.xml\"/>" + tree("T", "<X/>"));
  EXPECT_EQ(load(missing), missing + ":2: <include> " + (folder_ / "gone.xml").string() + ": no such file");
  const auto no_path = write("top.xml", "<include/>" + tree("T", "<X/>"));
  EXPECT_EQ(load(no_path), no_path + ":1: <include> needs the attribute [path]");
  const auto ros = write("top.xml", "<include ros_pkg=\"p\" path=\"x.xml\"/>" + tree("T", "<X/>"));
  EXPECT_EQ(load(ros), ros + ":1: [ros_pkg] of <include> is not supported");
  const auto broken = write("b.xml", "\n" + tree("B", "\n<Inverter/>"));
  const auto top = write("top.xml", "<include path=\"b.xml\"/>" + tree("T", "<X/>"));
  EXPECT_EQ(load(top, "T"), broken + ":3: 'Inverter' must have exactly 1 child, it has 0");
}

TEST_F(Include, Cycles) {
  write("a.xml", "<include path=\"b.xml\"/>" + tree("A", "<X/>"));
  write("b.xml", "<include path=\"a.xml\"/>" + tree("B", "<X/>"));
  const auto top = write("top.xml", "<include path=\"a.xml\"/>" + tree("T", "<X/>"));
  EXPECT_NE(load(top).find("includes itself"), std::string::npos);
  const auto self = write("self.xml", "<include path=\"self.xml\"/>" + tree("S", "<X/>"));
  EXPECT_NE(load(self).find("includes itself"), std::string::npos) << load(self);
}

TEST_F(Include, DoubledIdsNameBothPlaces) {
  const auto a = write("a.xml", tree("Same", "<X/>"));
  const auto top = write("top.xml", "<include path=\"a.xml\"/>\n" + tree("Same", "<X/>"));
  EXPECT_EQ(load(top), top + ":2: tree 'Same' is already defined in " + a + ":1");
}

TEST_F(Include, AFileThatIsNotThere) {
  EXPECT_NE(load((folder_ / "none.xml").string()).find("no such file"), std::string::npos);
}

}  // namespace adit::bt::test
