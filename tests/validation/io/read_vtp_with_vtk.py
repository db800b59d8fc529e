#!/usr/bin/env python3
"""Reads frames that lamella wrote with VTK's own reader and compares every array, unit and value.

usage: read_vtp_with_vtk.py WRITE_SAMPLE_FRAMES FOLDER
exit codes: 0 all as written, 1 something differs, 77 the vtk module is missing (ctest: skipped)
"""
import math
import subprocess
import sys

try:
    from vtkmodules.vtkCommonCore import vtkDataArray, vtkOutputWindow, vtkFileOutputWindow
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError as error:
    print(f"skipped: {error}; Debian has it as python3-vtk9")
    sys.exit(77)

failures = 0


def expect(condition, message):
    global failures
    if not condition:
        failures += 1
        print("FAILED:", message)


def same(a, b):
    return a == b or (math.isnan(a) and math.isnan(b))


# VTK's names for a type depend on the machine.
TYPES = {"Float64": ["double"], "Int64": ["long", "long long"], "Int32": ["int"]}


def expect_array(data, name, unit, components, expected, type_name):
    array = data.GetAbstractArray(name)
    expect(array is not None, f"{name} is missing")
    if array is None:
        return
    expect(array.GetDataTypeAsString() in TYPES[type_name], f"{name} is {array.GetDataTypeAsString()}, not {type_name}")
    expect(array.GetNumberOfComponents() == components, f"{name} has {array.GetNumberOfComponents()} components")
    key = vtkDataArray.UNITS_LABEL()
    found = array.GetInformation().Get(key) if array.GetInformation().Has(key) else None
    expect(found == unit, f"{name} has unit {found!r}, not {unit!r}")
    if components in (3, 9):
        axes = ["x", "y", "z"] if components == 3 else [a + b for a in "xyz" for b in "xyz"]
        names = [array.GetComponentName(k) for k in range(components)]
        expect(names == axes, f"{name} has components {names}")
    values = [array.GetComponent(i, k) for i in range(array.GetNumberOfTuples()) for k in range(components)]
    expect(len(values) == len(expected), f"{name} has {len(values)} values, not {len(expected)}")
    wrong = [i for i, (v, e) in enumerate(zip(values, expected)) if not same(v, e)]
    expect(not wrong, f"{name} differs first at value {wrong[:1]}")


def expect_text(data, name, expected):
    array = data.GetAbstractArray(name)
    found = array.GetValue(0) if array is not None and array.GetNumberOfValues() == 1 else None
    expect(found == expected, f"{name} is {found!r}, not {expected!r}")


def ramp(count):
    return [i / 3.0 - 1e-9 for i in range(count)]


def whole(count):
    return [9007199254740992.0 - i for i in range(count)]


def expect_frame_data(data):
    expect_array(data, "TimeValue", "s", 1, [0.1], "Float64")
    expect_array(data, "step", None, 1, [42], "Int64")
    expect_text(data, "solver", "bubble")
    expect_text(data, "time_unit", "s")
    expect_text(data, "length_unit", "m")
    expect_array(data, "box_dimension", None, 1, [2], "Int64")
    expect_array(data, "box_origin", "m", 3, [-1.0, 0.5, 0.0], "Float64")
    expect_array(data, "box_lengths", "m", 3, [3.0, 4.0, 0.0], "Float64")
    expect_array(data, "box_periodic", None, 3, [1, 0, 0], "Int32")
    expect_array(data, "energy", "J", 1, [1.0 / 3.0], "Float64")
    expect_array(data, "gas_fraction", "-", 1, [0.9], "Float64")
    expect(data.GetNumberOfArrays() == 11, f"{data.GetNumberOfArrays()} field data arrays")


def expect_cells(frame, vertices, points, triangles):
    expect(frame.GetNumberOfVerts() == points, f"{frame.GetNumberOfVerts()} vertex cells")
    expect(frame.GetNumberOfPolys() == triangles, f"{frame.GetNumberOfPolys()} polygons")
    cells = [tuple(frame.GetCell(i).GetPointId(k) for k in range(frame.GetCell(i).GetNumberOfPoints()))
             for i in range(frame.GetNumberOfCells())]
    expected = [(vertices + i,) for i in range(points)] + [(0, i + 1, i + 2) for i in range(triangles)]
    expect(cells == expected, "the cells are not as written")


def expect_frame(folder, name, points, triangles):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(f"{folder}/{name}.vtp")
    reader.Update()
    expect(reader.GetErrorCode() == 0, "the reader reports an error")
    frame = reader.GetOutput()
    vertices = triangles + 2 if triangles else 0
    expect_frame_data(frame.GetFieldData())
    expect_cells(frame, vertices, points, triangles)
    where = [(0.5 * i, 0.25, -1.0 * i) for i in range(vertices)] + [(i, -i / 3.0, 0.5) for i in range(points)]
    found = [frame.GetPoint(i) for i in range(frame.GetNumberOfPoints())]
    expect(found == where, "the positions are not as written")

    data = frame.GetPointData()
    nan = math.nan
    both = bool(points) + bool(triangles)
    if both:
        velocity = (ramp(3 * vertices) if triangles else []) + (ramp(3 * points) if points else [])
        expect_array(data, "velocity", "m/s", 3, velocity, "Float64")
    if points:
        expect_array(data, "radius", "m", 1, [nan] * vertices + [1 / (1 + i) for i in range(points)], "Float64")
        expect_array(data, "pressure", "Pa", 1, [nan] * vertices + ramp(points), "Float64")
        expect_array(data, "id", "-", 1, [-1] * vertices + whole(points), "Int64")
        expect_array(data, "stress", "Pa", 9, [nan] * 9 * vertices + ramp(9 * points), "Float64")
    if triangles:
        expect_array(data, "thickness", "m", 1, ramp(vertices) + [nan] * points, "Float64")
    expect(data.GetNumberOfArrays() == 4 * bool(points) + bool(triangles) + bool(both), "more point data than written")

    data = frame.GetCellData()
    if triangles:
        expect_array(data, "region_back", None, 1, [-1] * points + [i % 3 for i in range(triangles)], "Int32")
        expect_array(data, "region_front", None, 1, [-1] * points + [4] * triangles, "Int32")
        expect_array(data, "tension", "N/m", 1, [nan] * points + ramp(triangles), "Float64")
        expect_array(data, "film", "-", 1, [-1] * points + whole(triangles), "Int64")
    expect(data.GetNumberOfArrays() == 4 * bool(triangles), "more cell data than written")
    print(f"{name}: {frame.GetNumberOfPoints()} points, {frame.GetNumberOfCells()} cells")


def main():
    program, folder = sys.argv[1:]
    subprocess.run([program, folder], check=True)
    log = vtkFileOutputWindow()
    log.SetFileName(f"{folder}/vtk.log")
    log.FlushOn()
    open(f"{folder}/vtk.log", "w").close()
    vtkOutputWindow.SetInstance(log)
    expect_frame(folder, "empty", 0, 0)
    expect_frame(folder, "points", 40000, 0)
    expect_frame(folder, "surface", 0, 500)
    expect_frame(folder, "both", 400, 500)
    messages = open(f"{folder}/vtk.log").read()
    expect(not messages.strip(), f"VTK complained: {messages}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
