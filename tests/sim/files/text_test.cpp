// Input in messages: short, on one line, harmless to a terminal.
#include "sim/files/text.h"

#include <gtest/gtest.h>

#include "sim/files/error.h"

namespace icloth {
namespace {

std::size_t characters(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
  return count;
}

TEST(Text, ShortInputIsRepeatedAsItIs) {
  EXPECT_EQ(excerpt("proximity.thicknes"), "proximity.thicknes");
  EXPECT_EQ(excerpt(""), "");
  EXPECT_EQ(excerpt("Kleid für 30 €"), "Kleid für 30 €");
  EXPECT_EQ(in_quotes("a"), "'a'");
  EXPECT_EQ(excerpt(std::string(80, 'x')), std::string(80, 'x'));
}

TEST(Text, ANameStaysOnItsLineOfAFile) {
  EXPECT_EQ(file_line("a b,c"), "a b,c");
  EXPECT_EQ(file_line("a\nv 0 0 0\x7f"), "a_v 0 0 0_");
  EXPECT_EQ(file_line(std::string(500, 'x')), std::string(500, 'x'));
}

TEST(Text, LongInputLosesItsMiddle) {
  for (const std::size_t length : {81u, 200u, 641u, 5000u, 1u << 20}) {
    const std::string text = "begin" + std::string(length - 8, 'x') + "end";
    const std::string shown = excerpt(text);
    EXPECT_EQ(characters(shown), 80u) << length;
    EXPECT_TRUE(shown.starts_with("beginxxx") && shown.ends_with("xxxend")) << shown;
    EXPECT_NE(shown.find("…"), std::string::npos);
    EXPECT_TRUE(shown_path(text).ends_with("xxxend"));
    EXPECT_EQ(characters(shown_path(text)), 80u);
  }
  std::string wide;
  for (int k = 0; k < 1000; ++k) wide += "€";
  EXPECT_EQ(characters(excerpt(wide)), 80u);
  EXPECT_EQ(excerpt(wide).find('?'), std::string::npos) << "no character is cut in two";
}

TEST(Text, ControlCharactersAndBrokenUtf8BecomeHarmless) {
  EXPECT_EQ(harmless("a\nb\tc\rd"), "a b c d");
  EXPECT_EQ(harmless("a\x1b[31mb"), "a?[31mb");
  EXPECT_EQ(harmless("a\xff\xc3"), "a??");
  EXPECT_EQ(harmless("\xc0\xaf"), "??") << "longer than needed";
  EXPECT_EQ(harmless("\xed\xa0\x80"), "???") << "half a surrogate pair";
  EXPECT_EQ(harmless("\xf5\x80\x80\x80"), "????") << "beyond Unicode";
  EXPECT_EQ(harmless("a\xe2\x80\xae z"), "a? z") << "right to left";
  EXPECT_EQ(harmless("\xc2\x9b"
                     "31m"),
            "?31m")
      << "control sequence of one character";
  EXPECT_EQ(harmless(std::string("a\0b", 3)), "a?b");
}

TEST(Text, NoWordOfAnErrorIsLongerThanInputMayBe) {
  const InputError error("file: value " + std::string(3000, 'y') + ", expected one");
  EXPECT_LT(std::string_view(error.what()).size(), 120u) << error.what();
}

TEST(Text, MarkupHasNoMarksOfItsOwn) {
  EXPECT_EQ(markup_text("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(markup_text(""), "");
}

TEST(Text, NumbersReadBackAsTheSame) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-3), "-3");
  EXPECT_EQ(number_text(4e7), "40000000");
  EXPECT_EQ(number_text(1e300), "1e+300");
  EXPECT_EQ(rounded_text(0.95 / 3, 6), "0.316667");
  EXPECT_EQ(std::stod(number_text(1e-12 / 3)), 1e-12 / 3);
}

}  // namespace
}  // namespace icloth
