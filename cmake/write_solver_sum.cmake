# cmake -DSOURCE=FOLDER -DOUTPUT=FILE -P write_solver_sum.cmake
# Writes a check sum of all that decides what a step computes, the sources of sim/ and kernels/, into
# a header, leaving it alone when nothing changed.
file(GLOB_RECURSE sources RELATIVE ${SOURCE} ${SOURCE}/sim/*.h ${SOURCE}/sim/*.cpp ${SOURCE}/sim/*.cu
     ${SOURCE}/kernels/*.h)
list(SORT sources)
set(sums "")
foreach(source IN LISTS sources)
  file(SHA256 ${SOURCE}/${source} sum)
  string(APPEND sums "${source} ${sum}\n")
endforeach()
string(SHA256 sum "${sums}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define ICLOTH_SOLVER_SUM \"${sum}\"\n")
