# SPDX-License-Identifier: Apache-2.0
"""A GeoPackage as tests need one: one layer, its table said in full, so that it may be wrong."""

import sqlite3
import struct

TABLE = "CREATE TABLE roads (fid INTEGER PRIMARY KEY, geom LINESTRING, kind TEXT)"


def line_of(points, epsg):
    """A line as GeoPackage's blob: its header without an envelope, then WKB."""
    header = b"GP\0\1" + struct.pack("<i", epsg)
    body = struct.pack("<BII", 1, 2, len(points))
    return header + body + b"".join(struct.pack("<2d", *point) for point in points)


def geopackage(path, lines, epsg=32632, table=TABLE):
    """`lines`: (points, kind), written into the table `roads`. Where `table` makes a view of that
    name, it is what there is to read."""
    path.unlink(missing_ok=True)
    file = sqlite3.connect(path)
    file.execute("PRAGMA application_id = 0x47504B47")
    file.execute("PRAGMA user_version = 10200")
    file.execute(
        "CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT, srs_id INTEGER PRIMARY KEY,"
        " organization TEXT, organization_coordsys_id INTEGER, definition TEXT, description TEXT)"
    )
    file.execute(
        "CREATE TABLE gpkg_contents (table_name TEXT PRIMARY KEY, data_type TEXT, identifier TEXT,"
        " description TEXT, last_change DATETIME, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE,"
        " max_y DOUBLE, srs_id INTEGER)"
    )
    file.execute(
        "CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT,"
        " geometry_type_name TEXT, srs_id INTEGER, z TINYINT, m TINYINT)"
    )
    file.execute(
        "INSERT INTO gpkg_spatial_ref_sys VALUES ('a', ?, 'EPSG', ?, 'undefined', '')", (epsg, epsg)
    )
    file.execute(
        "INSERT INTO gpkg_contents VALUES ('roads', 'features', 'roads', '',"
        " '2026-01-01T00:00:00Z', 0, 0, 1, 1, ?)",
        (epsg,),
    )
    file.execute(
        "INSERT INTO gpkg_geometry_columns VALUES ('roads', 'geom', 'LINESTRING', ?, 0, 0)", (epsg,)
    )
    file.execute(table)
    if "VIEW" not in table:
        file.executemany(
            "INSERT INTO roads (geom, kind) VALUES (?, ?)",
            [(line_of(points, epsg), kind) for points, kind in lines],
        )
    file.commit()
    file.close()
