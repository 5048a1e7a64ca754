pixelflex_library(pixelflex_test_calibration
  HEADERS support_calibration/calibrated_rig.h support_calibration/registration.h
  SOURCES support_calibration/calibrated_rig.cpp support_calibration/registration.cpp
  PUBLIC pixelflex_procedure pixelflex_simulate)

pixelflex_test(registration_test LABEL gl TIMEOUT 300
  SOURCES accuracy/report_rig_test.cpp
  LINK pixelflex_test_calibration pixelflex_test_support pixelflex_plan pixelflex_renderer)

pixelflex_test(geometry_test LABEL unit
  SOURCES unit/geometry_mapping_test.cpp unit/geometry_display_test.cpp unit/geometry_mesh_test.cpp unit/geometry_nudge_test.cpp unit/geometry_screen_test.cpp
  LINK pixelflex_geometry)
pixelflex_test(patterns_blob_test LABEL unit SOURCES unit/patterns_blob_test.cpp unit/patterns_blob_photos_test.cpp unit/blob_photographs.h LINK pixelflex_patterns pixelflex_simulate)
pixelflex_test(patterns_dense_test LABEL unit
  SOURCES unit/patterns_dense_test.cpp
  LINK pixelflex_patterns pixelflex_simulate)
pixelflex_test(capture_test LABEL unit
  SOURCES unit/capture_folder_test.cpp unit/capture_live_test.cpp unit/capture_meter_test.cpp support/temporary_folder.cpp
  LINK pixelflex_capture)
pixelflex_test(estimate_test LABEL unit SOURCES unit/estimate_test.cpp unit/estimate_fit_test.cpp unit/estimate_joint_test.cpp unit/estimate_vignetting_test.cpp unit/estimate_smooth_field_test.cpp LINK pixelflex_estimate pixelflex_patterns)
pixelflex_test(estimate_light_test LABEL unit SOURCES unit/estimate_light_test.cpp unit/estimate_projector_light_test.cpp unit/test_camera.h LINK pixelflex_estimate pixelflex_patterns)
pixelflex_test(fiducials_test LABEL unit SOURCES unit/estimate_fiducials_test.cpp unit/estimate_fiducial_check_test.cpp LINK pixelflex_estimate pixelflex_simulate)
pixelflex_test(intrinsics_test LABEL unit SOURCES unit/estimate_intrinsics_test.cpp LINK pixelflex_estimate)
pixelflex_test(photometric_test LABEL unit SOURCES unit/photometric_test.cpp unit/photometric_mask_test.cpp unit/photometric_response_test.cpp unit/photometric_luminance_test.cpp unit/photometric_gamut_test.cpp unit/photometric_black_test.cpp unit/photometric_colour_test.cpp unit/photometric_view_test.cpp unit/photometric_wall.h LINK pixelflex_photometric)
pixelflex_test(report_test LABEL unit
  SOURCES
    unit/report_heat_test.cpp unit/report_html.h unit/report_light_test.cpp unit/report_light_figures_test.cpp unit/report_lit_wall.h unit/report_page_test.cpp unit/report_seams_test.cpp unit/summary_verdicts_test.cpp
    support_calibration/plain_wall.cpp support_calibration/plain_wall.h
  LINK pixelflex_report pixelflex_simulate pixelflex_test_support)
pixelflex_test(report_rig_test LABEL unit
  SOURCES unit/report_rig_test.cpp
  LINK pixelflex_report pixelflex_test_calibration pixelflex_test_support)
