# cmake -DOUTPUT=FILE.cpp -DSHADERS="a.glsl;b.glsl" -P embed_shaders.cmake
# Writes the shaders' texts into a source file, so that the program needs no files of its own.
set(text "// Made from render/shaders/ by render/embed_shaders.cmake.\n")
string(APPEND text "#include \"render/shader_program.h\"\n\nnamespace icloth {\n\n")
string(APPEND text "std::string_view embedded_shader(std::string_view name) {\n")
foreach(path ${SHADERS})
  get_filename_component(name ${path} NAME)
  file(READ ${path} source)
  string(APPEND text "  if (name == \"${name}\")\n    return R\"glsl(${source})glsl\";\n")
endforeach()
string(APPEND text "  return {};\n}\n\n}  // namespace icloth\n")
file(WRITE ${OUTPUT} "${text}")
