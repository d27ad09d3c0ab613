# `cmake --install` lays out a program that finds its module wherever the tree is moved to.
include(GNUInstallDirs)
install(TARGETS raytree RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The slash at the end installs what is in the folder, not the folder.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md")
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/raytree/scenes
        FILES_MATCHING PATTERN "*.json" PATTERN "*.obj" PATTERN "*.ply")
install(TARGETS raytree_image_io raytree_exr_io raytree_png_io LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/raytree)
