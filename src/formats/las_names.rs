//! Names of the fields of a LAS point, for its reader and its writer.

/// Names of the fields, as ASPRS and laspy have them.
pub(super) const FIELDS: [&str; 17] = [
    "intensity",
    "classification",
    "nir",
    "return_number",
    "number_of_returns",
    "scan_direction_flag",
    "edge_of_flight_line",
    "synthetic",
    "key_point",
    "withheld",
    "overlap",
    "scanner_channel",
    "scan_angle",
    "user_data",
    "point_source_id",
    "gps_time",
    "wave_packet",
];

/// Behind the name of a field in the name of extra bytes, which hold what the field cannot: shares of 1 in `intensity (float)`.
pub(super) const FLOAT: &str = " (float)";
