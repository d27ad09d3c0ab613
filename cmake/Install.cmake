# `cmake --install` lays out a program that finds its module wherever the tree is moved to.
include(GNUInstallDirs)
install(TARGETS raytree RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS raytree_image_io LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/raytree)
