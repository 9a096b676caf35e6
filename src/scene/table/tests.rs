//! Tests that the rows are whole: each kind has its entity, and the examples keep their own limits.

use super::*;

#[test]
fn every_kind_has_its_own_entity() {
    for entity in ENTITIES
        .iter()
        .filter(|entity| !UNSUPPORTED.contains(&entity.name))
    {
        assert!(std::ptr::eq(of(entity.kind), entity), "{}", entity.name);
        assert!(std::ptr::eq(find(entity.name.as_bytes()).unwrap(), entity));
    }
}

#[test]
fn examples_are_right() {
    for row in ENTITIES.iter().flat_map(Entity::rows) {
        let words: Vec<_> = row.example.split(' ').collect();
        let (count, numbers) = match row.take {
            _ if !row.required => continue,
            Take::Numbers(count, _) | Take::Integers(count, _) => (count, true),
            Take::OneOrThree(_) => (3, true),
            Take::Material(_) | Take::Texture(_) | Take::Picture => (1, false),
        };
        assert_eq!(words.len(), count, "{}", row.name);
        if numbers {
            let values: Vec<_> = words.iter().map(|word| word.parse().unwrap()).collect();
            assert!(row.limit.broken(&values).is_empty(), "{}", row.name);
        }
    }
}

#[test]
fn rows_fit_and_are_as_long_as_they_say() {
    for entity in &ENTITIES {
        assert!(entity.rows().count() <= MAX_ROWS, "{}", entity.name);
        for row in entity.rows() {
            if let Take::Numbers(count, field) | Take::Integers(count, field) = row.take {
                assert_eq!(
                    field(&mut Draft::default()).len(),
                    count,
                    "{} {}",
                    entity.name,
                    row.name
                );
            }
            assert_eq!(
                entity
                    .rows()
                    .filter(|other| other.is_called(row.name.as_bytes()))
                    .count(),
                1
            );
        }
    }
}
