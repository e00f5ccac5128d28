//! Turns and scales a cloud to the up axis and the unit that the format or the caller asks for.

use crate::base::error::{Error, Result};
use crate::cloud::{Unit, Viewpoints};
use crate::formats::raw_cloud::{Positions, RawCloud};
use glam::{DMat3, DVec3};

/// The cloud with `up` up and in `unit`, each where it is given: turned the shortest way, and scaled. Along axes that is exact but
/// for the unit. `asked`: the caller asks for it; else it is what the format would like, and a cloud that does not say how it
/// stands stays as it is.
///
/// # Errors
/// [`Error::BadOption`] where the caller asks, and the cloud does not say its own, or has no length.
pub(super) fn stand(
    cloud: &RawCloud,
    up: Wanted<[f64; 3]>,
    unit: Wanted<Unit>,
) -> Result<Option<RawCloud>> {
    let turn = match (up.value, cloud.up) {
        (Some(to), Some(from)) => Some(turn(DVec3::from_array(from), DVec3::from_array(to)))
            .filter(|m| *m != DMat3::IDENTITY),
        (Some(_), None) if up.asked => {
            return Err(unknown("up", "a cloud that says which way is up"));
        }
        _ => None,
    };
    let scale = match (unit.value, cloud.unit) {
        (Some(to), Some(from)) => match from.per(to) {
            Some(scale) => Some(scale).filter(|&scale| scale != 1.0),
            None if unit.asked && from != to => {
                return Err(unknown("unit", "lengths on both sides"));
            }
            None => None,
        },
        (Some(_), None) if unit.asked => return Err(unknown("unit", "a cloud that says its unit")),
        _ => None,
    };
    if turn.is_none() && scale.is_none() {
        return Ok(None);
    }
    let turn = turn.unwrap_or(DMat3::IDENTITY);
    let factor = scale.unwrap_or(1.0);
    let place = |p: DVec3| turn * p * factor;
    let mut moved = cloud.clone();
    moved.positions = match &cloud.positions {
        Positions::F32(values) => {
            let each = values
                .chunks_exact(3)
                .map(|p| place(DVec3::new(p[0].into(), p[1].into(), p[2].into())));
            Positions::F32(each.flat_map(|p| p.to_array().map(|x| x as f32)).collect())
        }
        Positions::F64(values) => {
            let each = values.chunks_exact(3).map(|p| place(DVec3::from_slice(p)));
            Positions::F64(each.flat_map(|p| p.to_array()).collect())
        }
    };
    if let Some(normals) = &mut moved.normals {
        for normal in normals.chunks_exact_mut(3) {
            let turned = turn * DVec3::new(normal[0].into(), normal[1].into(), normal[2].into());
            normal.copy_from_slice(&turned.to_array().map(|x| x as f32));
        }
    }
    #[cfg(feature = "exports")]
    for tangent in moved
        .skin
        .iter_mut()
        .flat_map(|skin| skin.tangents.iter_mut())
    {
        for tangent in tangent.chunks_exact_mut(4) {
            let turned = turn * DVec3::new(tangent[0].into(), tangent[1].into(), tangent[2].into());
            tangent[..3].copy_from_slice(&turned.to_array().map(|x| x as f32));
        }
    }
    moved.origin = cloud
        .origin
        .map(|origin| place(DVec3::from_array(origin)).to_array());
    moved.viewpoints = cloud.viewpoints.as_ref().map(|views| Viewpoints {
        positions: views.positions.iter().map(|&p| place(p)).collect(),
        of: views.of.clone(),
    });
    moved.up = cloud.up.map(|up| (turn * DVec3::from_array(up)).to_array());
    moved.unit = scale.and(unit.value).or(cloud.unit);
    // Coordinates are not those of the reference system any more.
    moved.crs = None;
    Ok(Some(moved))
}

/// What is wanted, and whether the caller asked for it.
#[derive(Clone, Copy)]
pub(super) struct Wanted<T> {
    pub(super) value: Option<T>,
    pub(super) asked: bool,
}

impl<T> Wanted<T> {
    /// What the caller asks for, or else what the format does.
    pub(super) fn of(asked: Option<T>, format: Option<T>) -> Wanted<T> {
        Wanted {
            asked: asked.is_some(),
            value: asked.or(format),
        }
    }
}

/// The shortest rotation from one direction to another; half a turn about an axis across.
fn turn(from: DVec3, to: DVec3) -> DMat3 {
    let (from, to) = (unit_axis(from), unit_axis(to));
    let (cos, axis) = (from.dot(to), from.cross(to));
    if cos <= -1.0 + 1e-12 {
        // About the axis of the caller's that is most across: x, or else y.
        let side = if from.x.abs() < 0.5 {
            DVec3::X
        } else {
            DVec3::Y
        };
        let across = (side - from * side.dot(from)).normalize();
        return DMat3::from_cols_array(&std::array::from_fn(|i| {
            let (column, row) = (i / 3, i % 3);
            2.0 * across[row] * across[column] - f64::from(u8::from(row == column))
        }));
    }
    let skew = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    DMat3::IDENTITY + skew + skew * skew * (1.0 / (1.0 + cos))
}

/// Of unit length; what single precision has made of an axis is the axis.
fn unit_axis(direction: DVec3) -> DVec3 {
    let unit = direction.normalize();
    let rounded = unit.round();
    if (unit - rounded).length() < 1e-6 {
        rounded
    } else {
        unit
    }
}

fn unknown(option: &str, expected: &str) -> Error {
    Error::BadOption {
        option: option.into(),
        expected: expected.into(),
        found: "asked of one that does not".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_along_axes_are_exact() {
        let sides = [
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            -DVec3::X,
            -DVec3::Y,
            -DVec3::Z,
        ];
        for from in sides {
            for to in sides {
                let m = turn(from, to);
                assert_eq!(m * from, to);
                assert_eq!(m.determinant(), 1.0);
                assert!(
                    m.to_cols_array()
                        .iter()
                        .all(|x| [0.0, 1.0].contains(&x.abs()))
                );
            }
        }
        assert_eq!(
            turn(DVec3::Z, DVec3::Y) * DVec3::new(1.0, 2.0, 3.0),
            DVec3::new(1.0, 3.0, -2.0)
        );
    }
}
