#pragma once
// Small XML files of BSDF data for tests.
#include <string>

namespace lightwalk::test {

/// A file of three patches: a basis of its own, of which `values` are Transmission Back.
inline std::string matrix_text(const std::string& values, const std::string& structure = "Columns",
                               const std::string& more = "") {
    return "<?xml version=\"1.0\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n"
           "<FileType>BSDF</FileType><Optical><Layer>\n"
           "<Material><Name>three</Name><Thickness unit=\"Centimeter\">2</Thickness></Material>\n"
           "<DataDefinition><IncidentDataStructure>" +
           structure +
           "</IncidentDataStructure>\n<AngleBasis><AngleBasisName>Own</AngleBasisName>\n"
           "<AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>0</LowerTheta>"
           "<UpperTheta>30</UpperTheta></ThetaBounds></AngleBasisBlock>\n"
           "<AngleBasisBlock><nPhis>2</nPhis><ThetaBounds><LowerTheta>30</LowerTheta>"
           "<UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock>\n"
           "</AngleBasis></DataDefinition>\n"
           "<WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>\n"
           "<WavelengthDataDirection>Transmission Back</WavelengthDataDirection>\n"
           "<ColumnAngleBasis>Own</ColumnAngleBasis><RowAngleBasis>Own</RowAngleBasis>\n"
           "<ScatteringData>\n" +
           values + "\n</ScatteringData></WavelengthDataBlock></WavelengthData>\n" + more +
           "</Layer></Optical></WindowElement>\n";
}

/// A file of a tensor tree, Reflection Back.
inline std::string tree_text(const std::string& values, int rank = 3,
                             const std::string& wavelength = "Visible") {
    return "<WindowElement><Optical><Layer><DataDefinition>\n<IncidentDataStructure>TensorTree" +
           std::to_string(rank) +
           "</IncidentDataStructure></DataDefinition>\n<WavelengthData><Wavelength>" + wavelength +
           "</Wavelength><WavelengthDataBlock>\n"
           "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n"
           "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n<ScatteringData>\n" +
           values +
           "\n</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical>"
           "</WindowElement>\n";
}

}  // namespace lightwalk::test
