# cmake --install and packages (cpack -G DEB): besides the programs, what a desktop needs to open
# scenes with the program.
include(GNUInstallDirs)
set(package ${CMAKE_CURRENT_LIST_DIR}/package)
install(FILES ${package}/icloth.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${package}/icloth.svg
        DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES ${package}/icloth.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
install(FILES ${package}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/icloth)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME icloth)
set(CPACK_PACKAGE_CONTACT "the icloth maintainers <maintainers@icloth.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "interactive cloth simulation without penetrations")
string(CONCAT CPACK_PACKAGE_DESCRIPTION
  "Drag cloth with the mouse, tune the solver while it moves, dress moving bodies from sewing\n"
  "patterns, make pictures and videos without a display. Cloth never goes through itself or a body.")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS ffmpeg)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
