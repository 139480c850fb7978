# cmake -DSOURCE=FOLDER -DOUTPUT=FILE -P write_commit.cmake
# Writes the commit of the source tree into a header, leaving it alone when nothing changed.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE result)
if(NOT result EQUAL 0 OR commit STREQUAL "")
  set(commit "$ENV{ICLOTH_COMMIT}")  # a copy without its repository: who copied it may say
endif()
if(commit STREQUAL "")
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define ICLOTH_COMMIT \"${commit}\"\n")
