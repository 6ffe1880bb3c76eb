# SPDX-License-Identifier: Apache-2.0
# Writes the files of idl/ into a C++ source: cmake -DIDL=folder -DOUT=file.cpp -P AditIdlTexts.cmake
file(GLOB_RECURSE files RELATIVE ${IDL} ${IDL}/*.idl)
list(SORT files)
set(out "#include \"core/record/idl_texts.hpp\"\n\nnamespace adit::record {\nnamespace {\n\nconstexpr IdlText texts[] = {\n")
foreach(file ${files})
  file(READ ${IDL}/${file} text)
  string(REGEX REPLACE "^ros2/" "" path ${file})
  string(APPEND out "    {\"${path}\", R\"idl(${text})idl\"},\n")
endforeach()
string(APPEND out "};\n\n}  // namespace\n\nstd::span<const IdlText> idl_texts() { return texts; }\n\n}  // namespace adit::record\n")
file(WRITE ${OUT} "${out}")
